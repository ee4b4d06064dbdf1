/// One CAD part, prepared for simulation: mesh, mass properties and collision shapes. A shape is made when a solver
/// first needs it, once per content and parameters, and kept in memory and in the disk cache.
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

/// Preparation done by this process so far. The second run of a program reads everything from the cache.
struct PartWork {
  std::size_t built = 0;  ///< meshes loaded and proxies computed
  std::size_t read = 0;   ///< taken from the disk cache instead
};

class PartModel {
 public:
  /// Loads through the cache. Throws like load_mesh.
  static std::shared_ptr<const PartModel> load(const std::string& path, const LoadOptions& options = {});
  /// From a mesh in memory (tests, generated shapes); `name` stands for the path.
  static std::shared_ptr<const PartModel> from_mesh(const Mesh& mesh, const std::string& name);
  static PartWork work();
  ~PartModel();

  const std::string& path() const;
  const Mesh& mesh() const;
  const LoadReport& load_report() const;
  const std::string& mesh_key() const;  ///< hash of the mesh: cache key of everything that depends on the mesh alone
  const MassProperties& mass() const;   ///< density 1
  double diagonal() const;              ///< of the bounding box (m): the unit of every relative error
  double radius() const;                ///< largest vertex distance from the centre of mass (m)

  struct State;  ///< defined in src/part

  // Proxies: thread-safe, lazy, cached on disk. References live as long as the model.
  const MeshQuery& query() const;
  const std::vector<Vec3>& corners() const;  ///< vertices that reach as far as the mesh, however it is turned
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
