/// What each pass of the GPU form takes, of one world and of many at once, in each phase of a pour. Worlds begin in
/// heaps of several seeds, each body moved a little by a seed of its own, and take 60 steps before they are timed: by
/// then they have parted, and find as few new pairs as worlds of a real batch do.
#include "framework/benchmark.hpp"
#include "framework/isolated.hpp"
#include "runs.hpp"

#include "bin_scenes/core/random.hpp"
#include "bin_scenes/output/scene_writer.hpp"
#include "pour/settling.hpp"
#include "solver/sphere_gl/gl_sphere_solver.hpp"

#include <algorithm>
#include <memory>
#include <numeric>

namespace bin_scenes::bench {
namespace {

struct Case {
  std::string phase;
  std::size_t worlds, world_group, pair_group;  ///< groups: invocations; 0: as the solver chooses
};

Row keys_of(const Case& of) {
  return Row::keys("phase", of.phase, "worlds", of.worlds, "world_group", of.world_group, "pair_group", of.pair_group);
}

Phase phase_of(const std::string& name) {
  return name == "pour"     ? phases::pour
         : name == "settle" ? phases::settle
         : name == "press"  ? phases::press
                            : phases::probe;
}

using Heap = std::vector<ScenePart>;

/// As far as neighbours in a heap of another seed differ after a moment: enough that no two worlds stay alike, and too
/// little to press parts into each other.
constexpr double jitter = 2e-5;  // m
/// To pour, the heap is stretched upwards, so that all of it falls.
constexpr double stretch = 1.15;

std::vector<WorldId> filled(Solver& solver, const LoadedRequest& all, const std::vector<Heap>& heaps, const Case& of) {
  std::vector<WorldId> ids;
  const WorldDef def = world_of(all);
  for (std::size_t w = 0; w < of.worlds; ++w) {
    ids.push_back(solver.add_world(def));
    solver.set_phase(ids.back(), phase_of(of.phase));
    Random random(all.request.seed, w, Stream::probe);
    const Heap& heap = heaps[w % heaps.size()];
    for (std::size_t i = 0; i < heap.size(); ++i) {
      BodyState state{heap[i].pose, {}};
      for (int axis = 0; axis < 3; ++axis) state.pose.position[axis] += jitter * random.uniform(-1.0, 1.0);
      if (of.phase == "pour") state.pose.position.z() *= stretch;
      solver.insert(ids.back(), i, state);
    }
  }
  return ids;
}

double awake(const Solver& solver, const std::vector<WorldId>& ids) {
  double sum = 0.0, bodies = 0.0;
  for (const WorldId id : ids)
    for (const bool sleeps : solver.asleep(id)) sum += sleeps ? 0 : 1, ++bodies;
  return sum / bodies;
}

/// Device time of each pass a step, all worlds together.
Row measured(const Request& request, const std::vector<Heap>& heaps, const Case& of, int before) {
  const LoadedRequest all = loaded(request);
  sphere_gl::Capacity capacity;
  capacity.world_group = of.world_group;
  capacity.pair_group = of.pair_group;
  capacity.bodies = heaps.front().size();
  capacity.memory = std::max(1e9, 4e6 * static_cast<double>(of.worlds));
  const std::unique_ptr<Solver> solver = make_gl_sphere_solver(request.solver.sphere, capacity);
  const std::vector<WorldId> ids = filled(*solver, all, heaps, of);
  constexpr int timed = 14;  // two slices of a pour
  solver->advance(ids, before * solver->step_size());
  const Profile start = solver->profile();
  const Clock clock;
  solver->advance(ids, timed * solver->step_size());
  const double wall_us = 1e6 * clock.wall_s(), cpu_us = 1e6 * clock.cpu_s();
  const Profile spent = solver->profile().since(start);
  const auto world_steps = static_cast<double>(spent.counters.at("steps"));
  const double steps = world_steps / static_cast<double>(of.worlds);
  Row row;
  row.measure("step_us", wall_us / steps).measure("world_us", wall_us / world_steps);
  row.measure("host_cpu_us_a_world", cpu_us / world_steps);
  for (const auto& [stage, ms] : spent.stages_ms) row.measure(stage + "_us", 1e3 * ms / steps);
  for (const char* name : {"pairs", "pairs_recycled", "contacts", "steps_repeated"}) {
    const auto counter = spent.counters.find(name);
    if (counter != spent.counters.end()) row.measure(name, static_cast<double>(counter->second) / world_steps);
  }
  return row.measure("awake_rel", awake(*solver, ids)).info("device", solver->device());
}

/// Heaps of several seeds, in files of `folder`.
std::vector<Heap> poured(const std::string& folder, const Request& request, std::size_t count) {
  const auto file = [&](std::size_t k) { return folder + "/heap" + std::to_string(k) + ".json"; };
  isolated([&] {
    const LoadedRequest all = loaded(request);
    std::vector<std::size_t> indices(count);
    std::iota(indices.begin(), indices.end(), std::size_t{0});
    const std::vector<Scene> scenes = pour(all, *solver_of(all), indices);
    for (std::size_t k = 0; k < count; ++k) write_text(file(k), scene_json(scenes[k], all));
    return Row();
  });
  std::vector<Heap> heaps;
  for (std::size_t k = 0; k < count; ++k) heaps.push_back(read_scene_json(file(k)).parts);
  return heaps;
}

std::vector<Case> cases(bool quick) {
  using Sizes = std::vector<std::size_t>;
  std::vector<Case> all;
  for (const std::size_t worlds : quick ? Sizes{1, 2} : Sizes{1, 264, 1056, 2112})
    for (const std::size_t world_group : quick ? Sizes{64} : Sizes{256, 128, 64})
      for (const std::size_t pair_group : quick ? Sizes{64} : Sizes{32, 64})
        for (const char* phase : {"settle", "press", "probe", "pour"})
          all.push_back({phase, worlds, world_group, pair_group});
  return all;
}

void run(Run& out) {
  Request request = bin_of("conrod", out.quick() ? 12 : 256);
  request.bin.inner_size = Vec3(0.40, 0.30, 0.20);  // m, as in config/conrods.yaml
  choose_solver(request, "sphere");
  Request on_gpu = request;
  choose_solver(on_gpu, "sphere/gpu");
  std::vector<Heap> heaps;
  for (const Case& of : cases(out.quick())) {
    if (!out.wanted(keys_of(of))) continue;
    if (heaps.empty()) heaps = poured(out.scratch(), request, out.quick() ? 2 : 4);
    const int before = out.quick() ? 8 : 60;
    out.row(keys_of(of).append(isolated([&] { return measured(on_gpu, heaps, of, before); }).row));
  }
}

const Registration registration{"passes",
                                "time of each pass of the GPU form, of one world and of many, by phase",
                                {"phase", "worlds", "world_group", "pair_group"},
                                run};

}  // namespace
}  // namespace bin_scenes::bench
