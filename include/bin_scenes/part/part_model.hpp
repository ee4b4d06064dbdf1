/// One CAD part, prepared for simulation: its mesh, mass properties and collision shapes. A collision shape is made
/// when a solver first needs it, once for each combination of contents and parameters. It is kept in memory and in the
/// disk cache (cache.hpp). A model is immutable to its users and may be shared between threads and requests.
#pragma once

#include "bin_scenes/mesh/mesh_loader.hpp"
#include "bin_scenes/part/convex_hulls.hpp"
#include "bin_scenes/part/distance_field.hpp"
#include "bin_scenes/part/mass_properties.hpp"
#include "bin_scenes/part/mesh_query.hpp"
#include "bin_scenes/part/samples.hpp"
#include "bin_scenes/part/shape_error.hpp"
#include "bin_scenes/part/spheres.hpp"

#include <memory>
#include <string>

namespace bin_scenes {

/// Counts of the preparation work of this process. A second run of a program reads everything from the cache.
struct PartWork {
  std::size_t built = 0;  ///< meshes that were loaded and shapes that were computed
  std::size_t read = 0;   ///< meshes and shapes that were read from the disk cache instead
};

/// A prepared part. References that its functions return are valid as long as the model lives.
class PartModel {
 public:
  /// Loads a model file through the cache. Throws like load_mesh().
  static std::shared_ptr<const PartModel> load(const std::string& path, const LoadOptions& options = {});
  /// Makes a model from a mesh in memory (for tests and generated shapes); `name` takes the place of the path.
  static std::shared_ptr<const PartModel> from_mesh(const Mesh& mesh, const std::string& name);
  static PartWork work();
  ~PartModel();

  const std::string& path() const;
  const Mesh& mesh() const;
  const LoadReport& load_report() const;
  /// Digest of the mesh, the cache key of everything that depends on the mesh only.
  const std::string& mesh_key() const;
  const MassProperties& mass() const;  ///< mass properties at a density of 1 kg/m3
  double diagonal() const;             ///< diagonal of the bounding box (m), to which all relative errors refer
  double radius() const;               ///< largest distance of a vertex from the centre of mass (m)

  struct State;  ///< defined in src/part

  // Collision shapes. They are made on first use, by whichever thread needs them first, and cached on disk.
  const MeshQuery& query() const;
  const std::vector<Vec3>& corners() const;  ///< vertices that extend as far as the whole mesh in every direction
  const SphereSet& spheres(const VoxelOptions& options) const;
  const DistanceField& field(const FieldOptions& options) const;
  const ConvexHulls& hulls(const HullOptions& options) const;
  const SampleSet& samples(const SampleOptions& options) const;

  ShapeError sphere_error(const VoxelOptions& options) const;
  ShapeError field_error(const FieldOptions& options) const;
  ShapeError hull_error(const HullOptions& options) const;

 private:
  PartModel();
  static std::shared_ptr<const PartModel> make(LoadedMesh loaded, const std::string& path);
  std::unique_ptr<State> state_;
};

using PartModelPtr = std::shared_ptr<const PartModel>;

}  // namespace bin_scenes
