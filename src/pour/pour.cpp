#include "bin_scenes/pour/pour.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/pour/heap.hpp"

#include <cstring>

namespace bin_scenes {

WorldDef world_of(const LoadedRequest& loaded) {
  const Request& request = loaded.request;
  WorldDef world;
  world.parts = loaded.parts;
  world.bin = request.bin;
  world.gravity = request.gravity;
  world.wall_height = request.bin.inner_size.z();
  world.exact_impacts = request.pour.pattern == Pour::Pattern::given;  // random poses are never symmetric
  if (request.bin.kind == Bin::Kind::mesh) {
    LoadOptions options;
    options.unit = request.bin.unit;
    options.require_closed = false;
    world.bin_model = loaded.bin_model ? loaded.bin_model : PartModel::load(request.bin.mesh, options);
  }
  for (std::size_t l = 0; l < request.parts.size(); ++l) {
    const PartLine& line = request.parts[l];
    BodyDef body;
    body.part = l;
    body.mass = mass_of(line, *loaded.parts[l]);
    body.friction = line.friction;
    body.restitution = line.restitution;
    body.fixed = line.stays();
    world.bodies.insert(world.bodies.end(), line.count, body);
  }
  BIN_SCENES_ASSERT(world.bodies.size() == request.part_count() && world.parts.size() == request.parts.size());
  BIN_SCENES_ASSERT(each_is(world.bodies, [](const BodyDef& body) { return body.mass > 0.0 && body.friction >= 0.0; }));
  return world;
}

std::uint64_t state_hash(const std::vector<ScenePart>& parts) {
  std::uint64_t hash = 0x9e3779b97f4a7c15ULL;
  const auto mix = [&](double value) {
    std::uint64_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    hash ^= bits;
    hash = (hash ^ (hash >> 30)) * 0xbf58476d1ce4e5b9ULL;  // the finaliser of SplitMix64
    hash = (hash ^ (hash >> 27)) * 0x94d049bb133111ebULL;
    hash ^= hash >> 31;
  };
  for (const ScenePart& part : parts) {
    for (int k = 0; k < 3; ++k) mix(part.pose.position[k]);
    for (int k = 0; k < 4; ++k) mix(part.pose.orientation.coeffs()[k]);
  }
  return hash;
}

std::vector<Scene> pour(const LoadedRequest& loaded, Solver& solver, const std::vector<std::size_t>& indices,
                        const RunHooks& hooks) {
  std::vector<Scene> scenes(indices.size());
  const SceneList list{indices.size(), [&](std::size_t place) { return indices[place]; }};
  const std::shared_ptr<Solver> of_caller(std::shared_ptr<Solver>(), &solver);  // which outlives the heaps
  settle_scenes(loaded, of_caller, "", list, hooks,
                [&](std::size_t place, Heap&& heap) { scenes[place] = heap.scene(); });
  return scenes;
}

}  // namespace bin_scenes
