/// Rotations after which a part looks the same, found on its mesh: what evaluations of poses need to know.
#pragma once

#include "bin_scenes/part/part_model.hpp"

#include <vector>

namespace bin_scenes {

/// Model frame, m.
struct Symmetries {
  struct Axis {
    Vec3 direction = Vec3::UnitZ();
    Vec3 point = Vec3::Zero();  ///< on the axis
  };
  std::vector<Axis> continuous;  ///< any angle
  std::vector<Pose> discrete;    ///< maps of the part onto itself, without the identity
};

/// Rotations about the centre of mass that move no point of the surface by more than `tolerance` * diagonal away from
/// the surface. Tried are the axes of inertia and, where two moments are equal, axes between them; orders 2 to 12 and
/// full turns. A part that is symmetric about another axis is not found out.
Symmetries find_symmetries(const PartModel& part, double tolerance = 0.01);

/// Largest distance of two vertices (m).
double diameter(const Mesh& mesh);

}  // namespace bin_scenes
