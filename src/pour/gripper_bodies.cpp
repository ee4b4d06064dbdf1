#include "pour/gripper_bodies.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace bin_scenes {

namespace {

constexpr double hole_share = 0.7;  ///< of a ring's radius; what presses is the outer edge

PartModelPtr box(const Vec3& size, const char* name) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.push_back(0.5 * size.cwiseProduct(Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return PartModel::from_mesh(mesh, name);
}

/// A tube from z = 0, its mouth, backwards.
PartModelPtr ring(double radius, double height) {
  constexpr std::uint32_t sides = 32;
  Mesh mesh;
  for (const double z : {-height, 0.0})
    for (const double r : {hole_share * radius, radius})
      for (std::uint32_t k = 0; k < sides; ++k) {
        const double angle = 2.0 * M_PI * k / sides;
        mesh.vertices.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
      }
  const std::uint32_t low_in = 0, low_out = sides, high_in = 2 * sides, high_out = 3 * sides;
  const auto band = [&](std::uint32_t from, std::uint32_t to) {  // to the left of `from`, seen from outside
    for (std::uint32_t k = 0; k < sides; ++k) {
      const std::uint32_t next = (k + 1) % sides;
      mesh.triangles.push_back({from + k, from + next, to + next});
      mesh.triangles.push_back({from + k, to + next, to + k});
    }
  };
  band(low_out, high_out);
  band(high_out, high_in);
  band(high_in, low_in);
  band(low_in, low_out);
  return PartModel::from_mesh(mesh, "ring");
}

}  // namespace

std::vector<GripperBody> bodies_of(const Gripper& g) {
  std::vector<GripperBody> bodies;
  const bool fingers = g.type == Gripper::Type::parallel;
  const double tip = fingers ? 0.5 * g.pad_length : 0.0;
  if (fingers) {
    if (!g.finger_mesh.empty()) {
      LoadOptions options;
      options.scale = g.finger_mesh_scale;
      const PartModelPtr finger = PartModel::load(g.finger_mesh, options);
      bodies.push_back({finger, {Vec3::Zero(), Quat(0.0, 0.0, 0.0, 1.0)}});  // half a turn about z
      bodies.push_back({finger, Pose()});
    } else {
      const PartModelPtr finger = box({g.finger_thickness, g.finger_width, g.finger_depth}, "finger");
      for (const double side : {-0.5, 0.5})
        bodies.push_back(
            {finger, {Vec3(side * g.finger_thickness, 0.0, tip - 0.5 * g.finger_depth), Quat::Identity()}});
    }
  } else {
    // A low one would count as a small part, for which the solver shortens its steps.
    bodies.push_back({ring(g.radius, std::max(3.0 * g.radius, 0.5 * g.finger_depth)), Pose()});
  }
  const Pose flange = g.flange();
  bodies.push_back({box(g.palm, "palm"), flange * Pose{Vec3(0.0, 0.0, 0.5 * g.palm.z()), Quat::Identity()}});
  return bodies;
}

}  // namespace bin_scenes
