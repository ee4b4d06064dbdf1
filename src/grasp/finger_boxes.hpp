/// A finger that is given as a mesh, as boxes that contain it.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"
#include "bin_scenes/scene/gripper.hpp"

#include <string>
#include <vector>

namespace bin_scenes {

/// Bounding boxes of slices across z; neighbouring slices with nearly the same box are one. The mesh is the finger at
/// +x in the gripper's frame with closed pads (scene/gripper.hpp). Throws an input Error at `key` if its pad is not in
/// the plane x = 0, or its tip is not at half the pad's length.
std::vector<Aabb> boxes_around(const Mesh& mesh, const Gripper& gripper, const std::string& key);

}  // namespace bin_scenes
