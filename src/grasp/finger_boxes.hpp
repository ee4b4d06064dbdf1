/// Boxes around a finger that is given as a mesh. Collisions of the gripper are tested with these boxes
/// (gripper_shape.hpp); simulated proofs use the mesh itself.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"
#include "bin_scenes/scene/gripper.hpp"

#include <string>
#include <vector>

namespace bin_scenes {

/// Returns the bounding boxes of slices across z; neighbouring slices with nearly equal boxes share one. The mesh is
/// the finger at +x in the gripper's frame with closed pads (scene/gripper.hpp). Throws an input Error that names `key`
/// if its pad is not in the plane x = 0, or if its tip is not at z = pad_length / 2.
std::vector<Aabb> boxes_around(const Mesh& mesh, const Gripper& gripper, const std::string& key);

}  // namespace bin_scenes
