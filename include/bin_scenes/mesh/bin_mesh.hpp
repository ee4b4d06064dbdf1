/// The triangles of a bin that is not given as a mesh file.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"
#include "bin_scenes/scene/request.hpp"

namespace bin_scenes {

/// Floor and walls of a box bin, in the bin frame.
Mesh box_bin_mesh(const Bin& bin);

}  // namespace bin_scenes
