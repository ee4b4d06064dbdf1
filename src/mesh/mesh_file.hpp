/// A model file as it was read: all triangles of all its meshes with the node transforms applied, in the unit and the
/// axes of the file. Nothing is welded or repaired yet.
#pragma once

#include "bin_scenes/mesh/mesh_loader.hpp"
#include "bin_scenes/scene/report.hpp"

#include <optional>
#include <string>
#include <vector>

namespace bin_scenes {

struct MeshFile {
  Mesh mesh;
  std::string format;  ///< "STL", "OBJ", "PLY", "DAE", "OFF", "STEP", "IGES"
  std::size_t meshes = 0;
  std::optional<double> metres_per_unit;  ///< the factor that the file states; none if it states none
  double tessellation_error = 0.0;        ///< STEP, IGES: largest distance of a triangle from the true surface
  std::vector<Flag> flags;                ///< remarks on what was repaired or left out
};

/// Throws an input Error with path, cause and remedy if the format is unknown, if assimp refuses the file (with its
/// fault, where that can be determined), or if it contains nothing but points or lines.
MeshFile parse_mesh_file(const ModelFile& file, const LoadOptions& options);

}  // namespace bin_scenes
