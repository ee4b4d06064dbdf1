/// Worlds of boxes of 1 kg, for the passes of the sphere solver.
#pragma once

#include "solver/sphere/world.hpp"

#include <cmath>
#include <cstdlib>
#include <string>

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

/// Two bars of 0.2 x 0.02 x 0.02 m on their edges, one across the other, whose edges overlap by `depth` (m). They cross
/// off the middle, so that no node lies at the crossing.
inline World crossed_bars(const Shape& bar, float depth) {
  World world = world_of_boxes(bar, 2);
  world.fine = true;
  const float half_diagonal = 0.01f * std::sqrt(2.0f), right = static_cast<float>(M_PI) / 2;
  world.bodies[0].q = Quatf(Eigen::AngleAxisf(0.5f * right, Vec3f::UnitX()));
  world.bodies[1].q = Quatf(Eigen::AngleAxisf(right, Vec3f::UnitZ())) * world.bodies[0].q;
  world.bodies[1].x = Vec3f(0.0137f, 0.0071f, 2 * half_diagonal - depth);
  return world;
}

/// A model of the folder models, or null if BIN_SCENES_MODELS does not name this folder.
inline PartModelPtr sample_part(const std::string& file) {
  const char* models = std::getenv("BIN_SCENES_MODELS");
  if (!models) return nullptr;
  LoadOptions options;
  options.unit = Unit::millimetre;
  return PartModel::load(models + ("/" + file), options);
}

}  // namespace bin_scenes::sphere
