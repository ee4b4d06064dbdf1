#include "bin_scenes/pour/pour.hpp"

#include "pour/settle_heaps.hpp"

#include "bin_scenes/core/cancel.hpp"

#include <chrono>
#include <cstring>
#include <map>

namespace bin_scenes {

WorldDef world_of(const Request& request, const std::vector<PartModelPtr>& parts, PartModelPtr bin_model) {
  WorldDef world;
  world.parts = parts;
  world.bin = request.bin;
  world.gravity = request.gravity;
  world.wall_height = request.bin.inner_size.z();
  if (request.bin.kind == Bin::Kind::mesh) {
    LoadOptions options;
    options.unit = request.bin.unit;
    options.require_closed = false;
    world.bin_model = bin_model ? bin_model : PartModel::load(request.bin.mesh, options);
  }
  for (std::size_t l = 0; l < request.parts.size(); ++l) {
    const PartLine& line = request.parts[l];
    BodyDef body;
    body.part = l;
    body.mass = line.mass ? *line.mass : line.density.value_or(1000.0) * parts[l]->mass().volume;
    body.friction = line.friction;
    body.restitution = line.restitution;
    body.fixed = line.fixed;
    world.bodies.insert(world.bodies.end(), line.count, body);
  }
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

void pour(const Request& request, const std::vector<PartModelPtr>& parts, Solver& solver, const SceneList& scenes,
          const RunHooks& hooks, PartModelPtr bin_model, const std::function<void(std::size_t, Scene&&)>& poured) {
  const CancelScope scope(hooks.cancel);
  struct Running {
    std::unique_ptr<HeapCore> heap;
    std::chrono::steady_clock::time_point begin;
  };
  const auto plan = std::make_shared<const PourPlan>(request, parts, std::move(bin_model));
  const Profile before = solver.profile();
  std::map<std::size_t, Running> running;
  HeapSource source;
  source.count = scenes.count;
  source.next = [&](std::size_t place) -> HeapCore& {
    Running& r = running[place];
    r.begin = std::chrono::steady_clock::now();
    r.heap = std::make_unique<HeapCore>(plan, solver, scenes.index(place));
    return *r.heap;
  };
  source.over = [&](std::size_t place) {
    Scene scene = running[place].heap->scene();
    scene.report.wall_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - running[place].begin).count();
    running.erase(place);
    if (scenes.count == 1) scene.report.profile.merge(solver.profile().since(before));  // heaps share its counters
    poured(place, std::move(scene));
  };
  settle_heaps(solver, source, hooks);
}

std::vector<Scene> pour(const Request& request, const std::vector<PartModelPtr>& parts, Solver& solver,
                        const std::vector<std::size_t>& indices, const RunHooks& hooks, PartModelPtr bin_model) {
  std::vector<Scene> scenes(indices.size());
  const SceneList list{indices.size(), [&](std::size_t place) { return indices[place]; }};
  pour(request, parts, solver, list, hooks, std::move(bin_model),
       [&](std::size_t place, Scene&& scene) { scenes[place] = std::move(scene); });
  return scenes;
}

}  // namespace bin_scenes
