#include "bin_scenes/mesh/bin_mesh.hpp"

namespace bin_scenes {

namespace {

void append_box(Mesh& mesh, const Vec3& lower, const Vec3& upper) {
  const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.emplace_back((i & 1 ? upper : lower).x(), (i & 2 ? upper : lower).y(), (i & 4 ? upper : lower).z());
  }
  for (const Triangle& t : {Triangle{0, 2, 3}, Triangle{0, 3, 1}, Triangle{4, 5, 7}, Triangle{4, 7, 6},
                            Triangle{0, 1, 5}, Triangle{0, 5, 4}, Triangle{2, 6, 7}, Triangle{2, 7, 3},
                            Triangle{0, 4, 6}, Triangle{0, 6, 2}, Triangle{1, 3, 7}, Triangle{1, 7, 5}}) {
    mesh.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
  }
}

}  // namespace

Mesh box_bin_mesh(const Bin& bin) {
  const double x = 0.5 * bin.inner_size.x(), y = 0.5 * bin.inner_size.y(), z = bin.inner_size.z(),
               t = bin.wall_thickness;
  Mesh mesh;
  append_box(mesh, {-x - t, -y - t, -t}, {x + t, y + t, 0.0});
  append_box(mesh, {-x - t, -y - t, 0.0}, {-x, y + t, z});
  append_box(mesh, {x, -y - t, 0.0}, {x + t, y + t, z});
  append_box(mesh, {-x, -y - t, 0.0}, {x, -y, z});
  append_box(mesh, {-x, y, 0.0}, {x, y + t, z});
  return mesh;
}

}  // namespace bin_scenes
