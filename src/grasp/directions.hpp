/// Directions of a part's shape with which grippers are aligned. They are candidates only: the searches of
/// parallel_grasps.hpp and suction_grasps.hpp turn the gripper to them first.
#pragma once

#include "bin_scenes/part/part_model.hpp"
#include "bin_scenes/part/symmetry.hpp"

#include <vector>

namespace bin_scenes {

/// Returns unit directions in the model frame: axes of rotational symmetry, then normals of large flat faces, then long
/// sharp straight edges, then the principal axes of inertia.
std::vector<Vec3> shape_directions(const PartModel& part, const Symmetries& symmetries);

/// Returns a unit direction perpendicular to `axis`: the projection of the first of the directions that is
/// perpendicular to it within three degrees or, if there is none, of the direction that is nearest to perpendicular.
Vec3 direction_across(const std::vector<Vec3>& directions, const Vec3& axis);

}  // namespace bin_scenes
