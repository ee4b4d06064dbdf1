/// From a model file (STL, OBJ, PLY, DAE, OFF; STEP and IGES where OpenCASCADE was there) to one closed,
/// outward-oriented mesh in metres. Coordinates stay in the file's own axes, whatever axis a DAE calls up (RViz, MoveIt
/// and Gazebo do the same), so that a pose of the part fits a marker of its file; a flag says so. A DAE's own unit is
/// honoured unless one is given.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"
#include "bin_scenes/scene/report.hpp"
#include "bin_scenes/scene/request.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace bin_scenes {

/// Largest model file (bytes).
constexpr std::uintmax_t max_model_file_size = std::uintmax_t{1} << 30;

struct LoadOptions {
  std::optional<Unit> unit;         ///< none: metres (or the file's own unit where the format states one)
  double scale = 1.0;               ///< multiplies after the unit
  double weld = 1e-6;               ///< vertices closer than this / diagonal are one
  double max_hole = 0.02;           ///< holes with a perimeter below this / diagonal are closed (1 = every hole)
  std::optional<double> thickness;  ///< m: an open surface becomes a shell of this thickness
  Tessellation tessellation;        ///< STEP, IGES
  std::string solid;                ///< STEP, IGES: the one to take, by name; empty: all, which must touch
  bool require_closed = true;       ///< false: report openness instead of throwing (inspect, bins)
};

/// The options that a part line of the request states for its model file.
LoadOptions load_options(const PartLine& line);

/// Whether this build reads STEP and IGES.
bool reads_cad();
/// Whether LoadReport::format is one of these two.
bool is_cad(const std::string& format);

/// A model file, read once, so that its digest belongs to the bytes that are used even if the file changes meanwhile.
struct ModelFile {
  std::string path;
  std::string bytes;
  std::string sha256;  ///< of the bytes
};

/// What was found in the file, and how it was repaired.
struct LoadReport {
  std::string format;
  std::size_t file_vertices = 0, file_triangles = 0, meshes = 0;  ///< meshes: solids, of STEP and IGES
  std::size_t welded_vertices = 0, degenerate_removed = 0, duplicate_removed = 0, holes_closed = 0;
  std::size_t t_junctions_split = 0;  ///< vertices inserted into long edges that met several short ones
  std::size_t turned = 0;             ///< triangles whose winding disagreed with their neighbours'
  std::size_t open_edges = 0;         ///< left after repair
  std::size_t shells = 0;             ///< connected components
  bool inverted = false;              ///< winding was inside out and has been turned
  bool closed = false;                ///< after repair
  Unit unit = Unit::metre;            ///< the one used, where it has a name
  double metres_per_unit = 1.0;       ///< the one used, scale not included
  double file_metres_per_unit =
      1.0;                          ///< the one that the file states (DAE, STEP, IGES); 1 where its format states none
  double tessellation_error = 0.0;  ///< m; STEP, IGES: largest distance of a triangle from the true surface
  std::vector<Flag> flags;          ///< one per repair; plain welding of equal vertices is none
  std::string content_sha256;       ///< of the file's bytes
};

struct LoadedMesh {
  Mesh mesh;
  LoadReport report;
};

/// Reads all meshes of a file with their node transforms applied, welds, checks and repairs.
/// Throws an input Error (missing, unreadable, empty, NaN, zero volume, still open) with path, cause and remedy.
/// Where assimp refuses a DAE, it is read once more without images, materials and animations: flag "file_mended".
/// Closed shells that overlap are united: flag "shells_united". If that fails (flag "shells_overlap"), the volume they
/// share counts twice in volume and mass; inside is their union (winding number, part/mesh_query.hpp).
LoadedMesh load_mesh(const ModelFile& file, const LoadOptions& options = {});
LoadedMesh load_mesh(const std::string& path, const LoadOptions& options = {});
/// Throws an input Error: missing, a folder, no regular file, unreadable, empty, above max_model_file_size.
ModelFile read_model_file(const std::string& path);

/// The same checks and repairs on a mesh that is in memory already (metres).
LoadedMesh repair_mesh(Mesh mesh, const LoadOptions& options, const std::string& where);

/// Throws an input Error when a part does not fit the bin (diagonal above the bin's), or when no unit was given and it
/// is below 1/2000 of the bin's longest side; without a unit the error names the likely one. An endless floor or free
/// flight stands for a bin of 10 m.
/// @param bin_mesh  the mesh of a bin that is given as one; its bounds are then the bin's size
void check_plausible_size(const Mesh& mesh, const Bin& bin, const std::string& path, std::optional<Unit> given,
                          const Mesh* bin_mesh = nullptr);

/// Throws an input Error when the mesh of a bin was read without a unit and is more than 10 m across, or its longest
/// side more than 2000 times as long as the largest part; the error names the likely unit.
/// @param largest_part  m: diagonal of the largest part whose unit was given; 0: none was.
void check_plausible_bin(const Mesh& mesh, const Bin& bin, double largest_part);

}  // namespace bin_scenes
