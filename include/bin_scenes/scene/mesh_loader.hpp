/// From a model file to one closed, outward-oriented mesh in metres. The only file that sees assimp is its source.
#pragma once

#include "bin_scenes/scene/mesh.hpp"
#include "bin_scenes/scene/report.hpp"
#include "bin_scenes/scene/request.hpp"

#include <optional>
#include <string>
#include <vector>

namespace bin_scenes {

struct LoadOptions {
  std::optional<Unit> unit;          ///< none: metres (or the file's own unit where the format states one, as DAE does)
  double scale = 1.0;                ///< multiplies after the unit
  double weld = 1e-6;                ///< vertices closer than this / diagonal are one
  double max_hole = 0.02;            ///< holes with a perimeter below this / diagonal are closed (1 = every hole)
  std::optional<double> thickness;   ///< m: an open surface becomes a shell of this thickness
  bool require_closed = true;        ///< false: report openness instead of throwing (inspect, bins)
};

/// What was found in the file and what was done about it.
struct LoadReport {
  std::string format;
  std::size_t file_vertices = 0, file_triangles = 0, meshes = 0;
  std::size_t welded_vertices = 0, degenerate_removed = 0, duplicate_removed = 0, holes_closed = 0;
  std::size_t open_edges = 0;        ///< left after repair
  std::size_t shells = 0;            ///< connected components
  bool inverted = false;             ///< winding was inside out and has been turned
  bool closed = false;               ///< after repair
  Unit unit = Unit::metre;           ///< the one used
  std::vector<Flag> flags;           ///< one per repair
  std::string content_sha256;        ///< of the file's bytes
};

struct LoadedMesh {
  Mesh mesh;
  LoadReport report;
};

/// Reads all meshes of a file with their node transforms applied, welds, checks and repairs.
/// Throws an input Error (missing, unreadable, empty, NaN, zero volume, still open) with path, cause and remedy.
LoadedMesh load_mesh(const std::string& path, const LoadOptions& options = {});

/// The same checks and repairs on a mesh that is in memory already (metres).
LoadedMesh repair_mesh(Mesh mesh, const LoadOptions& options, const std::string& where);

/// Throws an input Error that names the likely unit when a part of this diagonal (m) cannot be meant for the bin
/// (larger than the bin, or below 1/2000 of its longest side) and no unit was given.
void check_plausible_size(const Mesh& mesh, const Bin& bin, const std::string& path, std::optional<Unit> given);

}  // namespace bin_scenes
