/// Worlds of boxes of 1 kg, for the passes of the sphere solver.
#pragma once

#include "solver/sphere/world.hpp"

namespace bin_scenes::sphere {

inline Mesh box_mesh(const Vec3& size) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.push_back(0.5 * size.cwiseProduct(Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

inline Shape box_shape(PartModelPtr& part, const Vec3& size, double cell = 0.01) {
  part = PartModel::from_mesh(box_mesh(size), "box");
  return make_shape(*part, 64, 400, cell);
}

inline World world_of_boxes(const Shape& shape, std::size_t count) {
  World world;
  world.shapes = {&shape};
  world.smallest_size = shape.size;
  for (std::size_t i = 0; i < count; ++i) {
    Body b;
    b.inverse_mass = 1.0f;
    b.inertia = shape.unit_inertia;
    b.inverse_inertia = b.inertia.inverse();
    b.present = true;
    world.bodies.push_back(b);
  }
  return world;
}

}  // namespace bin_scenes::sphere
