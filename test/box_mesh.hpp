/// A box or cube around the origin, as a mesh and as the text of an STL file.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"

#include <sstream>
#include <string>

namespace bin_scenes {

inline Mesh box_mesh(const Vec3& size) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.push_back(size.cwiseProduct(Vec3(i & 1, (i >> 1) & 1, (i >> 2) & 1) - Vec3::Constant(0.5)));
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

inline Mesh box_mesh(double edge) {
  return box_mesh(Vec3::Constant(edge));
}

/// ASCII STL of the first `triangles` triangles: fewer than 12 leave the box open.
inline std::string box_stl(const Vec3& size, std::size_t triangles = 12) {
  const Mesh mesh = box_mesh(size);
  std::ostringstream out;
  out << "solid box\n";
  for (std::size_t t = 0; t < triangles; ++t) {
    const Vec3 n = mesh.area_vector(t).normalized();
    out << "facet normal " << n.x() << " " << n.y() << " " << n.z() << "\nouter loop\n";
    for (const auto index : mesh.triangles[t]) out << "vertex " << mesh.vertices[index].transpose() << "\n";
    out << "endloop\nendfacet\n";
  }
  out << "endsolid box\n";
  return out.str();
}

inline std::string box_stl(double edge, std::size_t triangles = 12) {
  return box_stl(Vec3(Vec3::Constant(edge)), triangles);
}

}  // namespace bin_scenes
