/// Loads a model file (STL, OBJ, PLY, DAE, OFF; STEP and IGES if the program was built with OpenCASCADE) as one closed,
/// outward-oriented mesh in metres. Coordinates keep the axes of the file, even if a DAE file declares another axis as
/// up, so that a pose of the part matches a marker of the file in RViz, MoveIt and Gazebo, which do the same; a flag
/// reports it. The unit that a DAE file declares is used unless the caller gives one. Collision shapes are made later,
/// by part/part_model.hpp.
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

/// How a file is read and repaired.
struct LoadOptions {
  /// Unit of the coordinates; none: that of the file if its format states one, otherwise metres.
  std::optional<Unit> unit;
  double scale = 1.0;      ///< factor that is applied after the unit
  double weld = 1e-6;      ///< vertices closer than weld * diagonal become one vertex
  double max_hole = 0.02;  ///< holes whose perimeter is below max_hole * diagonal are closed; 1 closes every hole
  std::optional<double> thickness;  ///< m: if given, an open surface becomes a shell of this thickness
  Tessellation tessellation;        ///< only for STEP and IGES
  std::string solid;           ///< STEP, IGES: name of the solid to use; empty: all solids, which must touch each other
  bool require_closed = true;  ///< false: an open mesh is reported instead of refused (for inspect and for bins)
};

/// Returns the options that a part line of the request states for its model file.
LoadOptions load_options(const PartLine& line);

/// Whether this program can read STEP and IGES files.
bool reads_cad();
/// Whether a format, as in LoadReport::format, is STEP or IGES.
bool is_cad(const std::string& format);

/// The bytes of a model file. It is read once, so that its digest belongs to the bytes that are used even if the file
/// changes in the meantime.
struct ModelFile {
  std::string path;
  std::string bytes;
  std::string sha256;  ///< digest of the bytes
};

/// The contents of a model file, and how they were repaired.
struct LoadReport {
  std::string format;
  std::size_t file_vertices = 0, file_triangles = 0,
              meshes = 0;  ///< counts before any repair; meshes: of STEP and IGES files, the solids
  std::size_t welded_vertices = 0, degenerate_removed = 0, duplicate_removed = 0, holes_closed = 0;
  std::size_t t_junctions_split = 0;  ///< vertices inserted into long edges that met several short ones
  std::size_t turned = 0;  ///< triangles that were turned because their winding disagreed with that of their neighbours
  std::size_t open_edges = 0;    ///< edges with one triangle only that remain after the repair
  std::size_t shells = 0;        ///< connected components
  bool inverted = false;         ///< the whole mesh was inside out and was turned
  bool closed = false;           ///< whether the mesh is closed after the repair
  Unit unit = Unit::metre;       ///< the unit that was used, if it is one of these
  double metres_per_unit = 1.0;  ///< the factor that was used, without LoadOptions::scale
  /// The factor that the file states (DAE, STEP, IGES); 1 for formats that state none.
  double file_metres_per_unit = 1.0;
  double tessellation_error = 0.0;  ///< m; STEP, IGES: largest distance of a triangle from the true surface
  std::vector<Flag> flags;          ///< one for each repair, except welding of equal vertices
  std::string content_sha256;       ///< digest of the bytes of the file
};

/// A mesh with the report of how it was loaded.
struct LoadedMesh {
  Mesh mesh;
  LoadReport report;
};

/// Reads all meshes of a file with their node transforms, welds their vertices, and checks and repairs the result.
/// Throws an input Error with path, cause and remedy if the file is missing, unreadable or empty, or if the mesh
/// contains NaN, has no volume, or is still open.
///
/// If assimp refuses a DAE file, the file is read once more without images, materials and animations (flag
/// "file_mended"). Closed shells that overlap are united (flag "shells_united"). If that fails (flag "shells_overlap"),
/// the volume that they share counts twice in volume and mass, while tests of inside and outside use their union
/// (winding number, part/mesh_query.hpp).
LoadedMesh load_mesh(const ModelFile& file, const LoadOptions& options = {});
LoadedMesh load_mesh(const std::string& path, const LoadOptions& options = {});
/// Reads the bytes of a model file. Throws an input Error if it is missing, not a regular file, unreadable, empty, or
/// larger than max_model_file_size.
ModelFile read_model_file(const std::string& path);

/// Makes the same checks and repairs on a mesh in memory (m). @param where  name of the mesh in error messages
LoadedMesh repair_mesh(Mesh mesh, const LoadOptions& options, const std::string& where);

/// Throws an input Error if a part does not fit into the bin (its diagonal exceeds that of the bin), or if no unit was
/// given and the part is smaller than 1/2000 of the longest side of the bin; in that case the error names the likely
/// unit. An endless floor, or no bin, counts as a bin of 10 m.
/// @param bin_mesh  mesh of the bin, if it is given by one; its bounds are then the size of the bin
void check_plausible_size(const Mesh& mesh, const Bin& bin, const std::string& path, std::optional<Unit> given,
                          const Mesh* bin_mesh = nullptr);

/// Throws an input Error if the mesh of a bin was read without a unit and is more than 10 m across, or if its longest
/// side is more than 2000 times the diagonal of the largest part. The error names the likely unit.
/// @param largest_part  m: diagonal of the largest part whose unit was given; 0 if there is none
void check_plausible_bin(const Mesh& mesh, const Bin& bin, double largest_part);

}  // namespace bin_scenes
