/// Reads STEP and IGES files and divides their surfaces into triangles with OpenCASCADE. The work runs in a contained
/// process (contained.hpp), like that of assimp.
#pragma once

#include "mesh_file.hpp"

namespace bin_scenes::cad {

/// The result that a contained process returns.
struct Solids {
  std::string complaint, remedy;   ///< error message; both are empty if the file was read
  Mesh mesh;                       ///< in the unit of the file
  std::uint64_t count = 0;         ///< number of solids in the file
  double metres_per_unit = 0.001;  ///< the factor that the file states
  double error = 0.0;              ///< largest distance of a triangle from the true surface, in the file's own unit
  std::vector<Flag> flags;
};

/// Reads the file in this process. `read_contained` protects from a crash or an endless loop of the library.
Solids read_here(const std::string& bytes, const std::string& format, const LoadOptions& options);

/// Reads the file in a contained process. Throws an input Error like parse_mesh_file().
MeshFile read_contained(const std::string& bytes, const std::string& format, const std::string& path,
                        const LoadOptions& options);

}  // namespace bin_scenes::cad
