/// Writes the meshes of models as PLY files. It also reads these files again; models of users are read by
/// mesh/mesh_loader.hpp.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"

#include <string>

namespace bin_scenes {

/// Reads a file of write_ply(), in the unit of the file. Throws an input Error for any other file.
Mesh read_ply(const std::string& path);

}  // namespace bin_scenes
