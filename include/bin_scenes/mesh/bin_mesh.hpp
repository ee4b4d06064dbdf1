/// The mesh of a bin that the request describes by its dimensions. Sensors and the search for grasps use this mesh;
/// solvers and the quality measures use exact planes instead.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"
#include "bin_scenes/scene/request.hpp"

namespace bin_scenes {

/// Returns the floor and the four walls of a box bin in the bin frame (m): five closed boxes that touch each other.
Mesh box_bin_mesh(const Bin& bin);

}  // namespace bin_scenes
