#include "bin_scenes/part/part_model.hpp"

#include "part_cache.hpp"
#include "part_state.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/part/hull_geometry.hpp"

#include <algorithm>

namespace bin_scenes {

std::atomic<std::size_t> PartWorkCounter::built{0}, PartWorkCounter::read{0};

namespace {

std::string key_of(const FieldOptions& o) {
  return key_text(o.cell) + key_text(o.padding) + std::to_string(o.max_nodes);
}
std::string key_of(const SampleOptions& o) {
  return std::to_string(o.count) + " " + key_text(o.sharp_angle);
}
std::string key_of(const HullOptions& o) {
  return key_text(o.max_error) + key_text(o.max_volume_error) + std::to_string(o.max_hulls) + " " +
         std::to_string(o.max_vertices);
}
std::string key_of(const VoxelOptions& o) {
  std::string key = std::to_string(o.voxels) + " " + key_text(o.tightness) + (o.keep_interior ? "keep " : "");
  for (const double radius : o.radii) key += key_text(radius);
  return key;
}

/// Looks a proxy up in memory, then on disk, then makes it. The lock is held throughout, so that a second thread waits
/// for the first one's result instead of making its own.
template <class T, class Options, class Make>
const T& proxy(PartModel::State& state, PartModel::State::Made<T>& made, const char* kind, const Options& options,
               Make&& make) {
  const std::string key = key_of(options);
  const std::lock_guard<std::mutex> lock(made.mutex);
  auto& slot = made.by_options[key];
  if (!slot) slot = std::make_unique<T>(cached<T>(kind, state.mesh_key + " " + key, make));
  return *slot;
}

std::string key_of(const Mesh& mesh) {
  const std::uint64_t vertices = mesh.vertices.size(), triangles = mesh.triangles.size();
  return Sha256()
      .add(&vertices, sizeof vertices)
      .add(mesh.vertices.data(), vertices * sizeof(Vec3))
      .add(&triangles, sizeof triangles)
      .add(mesh.triangles.data(), triangles * sizeof(Triangle))
      .hex();
}

}  // namespace

PartModel::PartModel() : state_(std::make_unique<State>()) {}
PartModel::~PartModel() = default;

PartWork PartModel::work() {
  return {PartWorkCounter::built, PartWorkCounter::read};
}

std::shared_ptr<const PartModel> PartModel::make(LoadedMesh loaded, const std::string& path) {
  const std::shared_ptr<PartModel> part(new PartModel);
  State& state = *part->state_;
  state.path = path;
  state.loaded = std::move(loaded);
  const Mesh& mesh = state.loaded.mesh;
  state.mesh_key = key_of(mesh);
  state.mass = mass_properties(mesh);
  state.diagonal = mesh.bounds().diagonal();
  for (const Vec3& v : mesh.vertices) state.radius = std::max(state.radius, (v - state.mass.center).norm());
  BIN_SCENES_ASSERT(std::isfinite(state.diagonal) && std::isfinite(state.radius) && !state.mesh_key.empty());
  BIN_SCENES_ASSERT(2.0 * state.radius >= state.diagonal * 0.5 || mesh.empty());
  return part;
}

std::shared_ptr<const PartModel> PartModel::from_mesh(const Mesh& mesh, const std::string& name) {
  LoadedMesh loaded;
  loaded.mesh = mesh;
  loaded.report.format = "memory";
  loaded.report.file_vertices = mesh.vertices.size();
  loaded.report.file_triangles = mesh.triangles.size();
  loaded.report.meshes = 1;
  loaded.report.closed = true;
  loaded.report.content_sha256 = key_of(mesh);
  return make(std::move(loaded), name);
}

const std::string& PartModel::path() const {
  return state_->path;
}
const Mesh& PartModel::mesh() const {
  return state_->loaded.mesh;
}
const LoadReport& PartModel::load_report() const {
  return state_->loaded.report;
}
const std::string& PartModel::mesh_key() const {
  return state_->mesh_key;
}
const MassProperties& PartModel::mass() const {
  return state_->mass;
}
double PartModel::diagonal() const {
  return state_->diagonal;
}
double PartModel::radius() const {
  return state_->radius;
}

const std::vector<Vec3>& PartModel::corners() const {
  std::call_once(state_->corners_once, [this] { state_->corners = extreme_points(mesh().vertices); });
  BIN_SCENES_ASSERT(!state_->corners.empty() || mesh().vertices.empty());
  return state_->corners;
}

const MeshQuery& PartModel::query() const {
  std::call_once(state_->query_once, [this] { state_->query = std::make_unique<MeshQuery>(mesh()); });
  return *state_->query;
}

const SphereSet& PartModel::spheres(const VoxelOptions& options) const {
  return proxy(*state_, state_->spheres, "spheres", options, [&] { return voxel_spheres(query(), options); });
}
const DistanceField& PartModel::field(const FieldOptions& options) const {
  return proxy(*state_, state_->fields, "field", options, [&] { return distance_field(query(), options); });
}
const ConvexHulls& PartModel::hulls(const HullOptions& options) const {
  return proxy(*state_, state_->hulls, "hulls", options, [&] { return convex_hulls(query(), options); });
}
const SampleSet& PartModel::samples(const SampleOptions& options) const {
  return proxy(*state_, state_->samples, "samples", options, [&] { return surface_samples(query(), options); });
}

ShapeError PartModel::sphere_error(const VoxelOptions& options) const {
  VoxelOptions whole = options;
  whole.keep_interior = true;
  return shape_error(spheres(options), voxel_spheres(query(), whole), query());
}
ShapeError PartModel::field_error(const FieldOptions& options) const {
  return shape_error(field(options), query());
}
ShapeError PartModel::hull_error(const HullOptions& options) const {
  return shape_error(hulls(options), query());
}

}  // namespace bin_scenes
