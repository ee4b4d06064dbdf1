#include "bin_scenes/pour/pour.hpp"

#include "pour/pour_world.hpp"
#include "solver/step_limit.hpp"

#include "bin_scenes/core/cancel.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>

namespace bin_scenes {

namespace {

constexpr double slice_seconds = 1.0 / 60.0;  ///< simulated time between two looks at a world

struct Running {
  std::size_t place;  ///< in the list of indices
  std::unique_ptr<PourWorld> world;
  std::chrono::steady_clock::time_point begin;
};

/// Worlds that are simulated and looked at together. Of two groups one is looked at while the device works on the
/// other.
struct Group {
  std::vector<Running> running;
  std::uint64_t left = 0;       ///< steps to the end of the slice
  std::uint64_t clock = 0;      ///< steps of the world that is traced
  bool begun = false;           ///< a piece of the slice
  std::uint64_t under_way = 0;  ///< its steps
  double seconds = 0.0;         ///< simulated by them
  std::vector<WorldId> ids() const {
    std::vector<WorldId> all;
    for (const Running& r : running) all.push_back(r.world->id());
    return all;
  }
};

/// Step at whose end the next sample of a trace is due: the one nearest to a multiple of 1 / rate (Hz).
std::uint64_t next_sample(std::uint64_t now, double rate, double step) {
  const double number = std::floor((static_cast<double>(now) + 0.5) * step * rate) + 1.0;
  return std::max(now + 1, static_cast<std::uint64_t>(std::llround(number / (rate * step))));
}

}  // namespace

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

void pour(const Request& request, const std::vector<PartModelPtr>& parts, Solver& solver,
          const SceneList& scenes, const RunHooks& hooks, PartModelPtr bin_model,
          const std::function<void(std::size_t, Scene&&)>& poured) {
  const CancelScope scope(hooks.cancel);
  const PourPlan plan(request, parts, std::move(bin_model));
  const double step = solver.step_size();
  const auto slice = static_cast<std::uint64_t>(std::max(1.0, std::round(slice_seconds / step)));
  const bool tracing = hooks.trace && hooks.trace_rate > 0.0;
  // Trace samples count from each world's own start, so a traced world runs by itself. It makes no other difference.
  const std::size_t at_once = tracing ? 1 : std::max<std::size_t>(1, solver.worlds_at_once());
  std::vector<Group> groups(solver.works_aside() && at_once > 1 ? 2 : 1);
  const std::size_t group_size = at_once / groups.size();

  std::size_t next = 0, done = 0;
  double fraction = 0.0;
  double last_sample = 0.0;  // s
  const Profile before = solver.profile();

  const auto sample = [&](Running& r) {
    last_sample = r.world->time();
    hooks.trace(r.world->index(), last_sample, r.world->states());
  };
  const auto finish_if = [&](Group& group, auto&& over) {
    const auto finished = [&](Running& r) {
      if (!over(*r.world)) return false;
      if (tracing && r.world->time() > last_sample) sample(r);
      Scene scene = r.world->scene();
      scene.report.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - r.begin).count();
      r.world.reset();
      ++done;
      if (scenes.count == 1) scene.report.profile.merge(solver.profile().since(before));  // worlds share its counters
      poured(r.place, std::move(scene));
      return true;
    };
    group.running.erase(std::remove_if(group.running.begin(), group.running.end(), finished), group.running.end());
  };
  const auto fill = [&](Group& group) {
    if (group.running.empty()) group.clock = 0;
    while (group.running.size() < group_size && next < scenes.count) {
      group.running.push_back({next, nullptr, std::chrono::steady_clock::now()});
      Running& r = group.running.back();
      r.world = std::make_unique<PourWorld>(plan, solver, scenes.index(next++));
      if (tracing) sample(r);
    }
    group.left = slice;
  };
  // A slice, in pieces that also end where a trace sample or a world's set time is due.
  const auto begin_piece = [&](Group& group) {
    std::uint64_t steps = group.left;
    if (tracing) steps = std::min(steps, next_sample(group.clock, hooks.trace_rate, step) - group.clock);
    double seconds = static_cast<double>(steps) * step;
    for (const Running& r : group.running) seconds = std::min(seconds, r.world->time_left());
    group.under_way = steps_in(seconds, step).count();
    if (group.under_way > 0) group.seconds = solver.begin(group.ids(), seconds);
  };
  const auto end_piece = [&](Group& group) {
    if (group.under_way > 0) {
      solver.finish(group.ids());
      for (Running& r : group.running) r.world->advanced(group.seconds);
      const bool due =
          tracing && group.clock + group.under_way == next_sample(group.clock, hooks.trace_rate, step);
      group.clock += group.under_way;
      group.left -= group.under_way;
      if (due)
        for (Running& r : group.running) sample(r);
    }
    finish_if(group, [&](PourWorld& world) {
      if (world.time_left() > 0.0) return false;
      world.judge();
      return true;
    });
  };
  const auto tell = [&](const Group& looked_at) {
    if (!hooks.progress) return;
    double sum = static_cast<double>(done);
    for (const Group& group : groups)
      for (const Running& r : group.running) sum += r.world->progress().fraction;
    fraction = std::max(fraction, sum / static_cast<double>(scenes.count));
    for (const Running& r : looked_at.running) {
      Progress progress = r.world->progress();
      progress.fraction = fraction;
      hooks.progress(progress);
    }
  };

  for (Group& group : groups) fill(group);
  while (done < scenes.count) {
    for (Group& group : groups) {
      stop_if_cancelled();
      if (group.begun) {
        end_piece(group);
        if (group.left == 0) {
          for (Running& r : group.running) r.world->look();
          tell(group);
          finish_if(group, [](PourWorld& world) { return world.over(); });
        }
        if (group.left == 0 || group.running.empty()) fill(group);
      }
      group.begun = !group.running.empty();
      if (group.begun) begin_piece(group);
    }
  }
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
