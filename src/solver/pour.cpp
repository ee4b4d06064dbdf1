#include "bin_scenes/solver/pour.hpp"

#include "pour_world.hpp"

#include "bin_scenes/core/error.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>

namespace bin_scenes {

namespace {

constexpr double slice_seconds = 1.0 / 60.0;  ///< simulated time between two looks at a world

struct Running {
  std::size_t slot;  ///< position in the result
  std::unique_ptr<PourWorld> world;
  std::chrono::steady_clock::time_point begin;
};

/// Largest whole number of steps that ends no later than any of the marks that lie ahead.
std::uint64_t steps_until_mark(std::uint64_t now, std::uint64_t every) {
  return every - now % every;
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

std::vector<Scene> pour(const Request& request, const std::vector<PartModelPtr>& parts, Solver& solver,
                        const std::vector<std::size_t>& indices, const RunHooks& hooks, PartModelPtr bin_model) {
  const PourPlan plan(request, parts, std::move(bin_model));
  const double step = solver.step_size();
  const auto whole_steps = [&](double seconds) {
    return static_cast<std::uint64_t>(std::max(1.0, std::round(seconds / step)));
  };
  const std::uint64_t slice = whole_steps(slice_seconds);
  const bool tracing = hooks.trace && hooks.trace_rate > 0.0;
  const std::uint64_t trace_every = tracing ? whole_steps(1.0 / hooks.trace_rate) : slice;
  // Trace samples count from each world's own start, so a traced world runs by itself. It makes no other difference.
  const std::size_t at_once = tracing ? 1 : std::max<std::size_t>(1, solver.worlds_at_once());

  std::vector<Scene> scenes(indices.size());
  std::vector<Running> running;
  std::size_t next = 0, done = 0;
  std::uint64_t clock = 0;  // steps; only its remainders matter, worlds start and end on whole slices
  double fraction = 0.0;
  const Profile before = solver.profile();

  const auto finish = [&](Running& r) {
    Scene& scene = scenes[r.slot];
    scene = r.world->scene();
    scene.report.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - r.begin).count();
    r.world.reset();
    ++done;
  };
  while (done < indices.size()) {
    while (running.size() < at_once && next < indices.size()) {
      running.push_back({next, nullptr, std::chrono::steady_clock::now()});
      running.back().world = std::make_unique<PourWorld>(plan, solver, indices[next++]);
      if (tracing) hooks.trace(running.back().world->index(), 0.0, running.back().world->states());
    }
    if (hooks.cancel && hooks.cancel->load()) throw Error(ErrorKind::cancelled, "cancelled", "pour", "ask again");

    // One slice, in pieces that also end where a trace sample or a world's set time is due.
    std::uint64_t left = slice;
    while (left > 0 && !running.empty()) {
      std::uint64_t steps = left;
      if (tracing) steps = std::min(steps, steps_until_mark(clock, trace_every));
      for (const Running& r : running) steps = std::min(steps, r.world->steps_left(step));
      if (steps > 0) {
        std::vector<WorldId> ids;
        for (const Running& r : running) ids.push_back(r.world->id());
        const double seconds = solver.advance(ids, static_cast<double>(steps) * step);
        for (Running& r : running) r.world->advanced(seconds);
        clock += steps;
        left -= steps;
        if (tracing && clock % trace_every == 0)
          for (Running& r : running) hooks.trace(r.world->index(), r.world->time(), r.world->states());
      }
      const auto over = [&](Running& r) {
        if (r.world->steps_left(step) > 0) return false;
        r.world->judge();
        finish(r);
        return true;
      };
      running.erase(std::remove_if(running.begin(), running.end(), over), running.end());
    }
    for (Running& r : running) r.world->look();
    if (hooks.progress) {
      double sum = static_cast<double>(done);
      for (const Running& r : running) sum += r.world->progress().fraction;
      fraction = std::max(fraction, sum / static_cast<double>(indices.size()));
      for (const Running& r : running) {
        Progress progress = r.world->progress();
        progress.fraction = fraction;
        hooks.progress(progress);
      }
    }
    const auto over = [&](Running& r) {
      if (!r.world->over()) return false;
      finish(r);
      return true;
    };
    running.erase(std::remove_if(running.begin(), running.end(), over), running.end());
    if (tracing && running.empty()) clock = 0;
  }

  if (indices.size() == 1) {  // the solver's counters cannot be told apart by world
    Profile& profile = scenes[0].report.profile;
    profile.merge(solver.profile());
    for (const auto& [name, ms] : before.stages_ms) profile.stages_ms[name] -= ms;
    for (const auto& [name, n] : before.counters) profile.counters[name] -= n;
  }
  return scenes;
}

}  // namespace bin_scenes
