/// Reads a mesh file with assimp. No other file includes assimp's headers. The result is not repaired; mesh_loader.cpp
/// does that.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"

#include <cstdint>
#include <string>

namespace bin_scenes {

/// The mesh that assimp reads from a file, or its error message.
struct Import {
  std::string complaint;  ///< error message; empty if the file was read
  Mesh mesh;
  std::uint64_t meshes = 0, points = 0, lines = 0;
};

/// Runs assimp in a process of its own, which returns the result through a pipe.
Import import_contained(const std::string& bytes, const std::string& format);

}  // namespace bin_scenes
