/// How the cost of a step grows: with the parts of a world, and with the worlds of a batch. Heaps at rest on an endless
/// floor, every part awake. One heap is poured once and set up as often as needed, so that the cost of a step can be
/// measured without pouring 65,536 parts.
#include "framework/benchmark.hpp"
#include "framework/isolated.hpp"
#include "framework/statistics.hpp"
#include "runs.hpp"

#include "bin_scenes/output/scene_writer.hpp"
#include "pour/settling.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

namespace bin_scenes::bench {
namespace {

constexpr const char* part = "channel_u";

/// `count` parts at rest on an endless floor.
struct Heap {
  Request request;
  std::vector<BodyState> rest;
  double width = 0.0;  ///< edge of a square that holds the heap, with some room around it (m)
};

Heap heap_at_rest(std::size_t count, const std::string& path) {
  Heap heap;
  heap.request = bin_of(part, count);
  heap.request.bin = Bin();
  heap.request.bin.kind = Bin::Kind::floor;
  choose_solver(heap.request, "sphere");
  pour_into(path, heap.request);
  Aabb box;
  for (const ScenePart& p : read_scene_json(path).parts) {
    heap.rest.push_back({p.pose, {}});
    box.extend(p.pose.position);
  }
  heap.width = std::max(box.size().x(), box.size().y()) + 3.0 * loaded(heap.request).parts.front()->diagonal();
  return heap;
}

/// `per_world` heaps side by side in each of `worlds` new worlds of the solver.
std::vector<WorldId> add_worlds(Solver& solver, const WorldDef& def, const Heap& heap, std::size_t per_world,
                                std::size_t worlds) {
  const auto columns = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(per_world))));
  const double side = heap.width * static_cast<double>(columns - 1);
  std::vector<WorldId> ids;
  for (std::size_t w = 0; w < worlds; ++w) {
    ids.push_back(solver.add_world(def));
    solver.set_phase(ids.back(), phases::settle);
    for (std::size_t h = 0, body = 0; h < per_world; ++h) {
      const Vec3 middle(heap.width * static_cast<double>(h % columns) - 0.5 * side,
                        heap.width * static_cast<double>(h / columns) - 0.5 * side, 0.0);
      for (BodyState state : heap.rest) {
        state.pose.position += middle;
        solver.insert(ids.back(), body++, state);
      }
    }
  }
  return ids;
}

/// A few steps to build contacts, then the samples; parts do not fall asleep that soon.
Row step_row(const Heap& heap, const std::string& solver_name, std::size_t per_world, std::size_t worlds) {
  Request request = heap.request;
  choose_solver(request, solver_name);
  request.parts[0].count = heap.rest.size() * per_world;
  const LoadedRequest all = loaded(request);
  const std::unique_ptr<Solver> solver = solver_of(all);
  const std::vector<WorldId> ids = add_worlds(*solver, world_of(all), heap, per_world, worlds);
  const auto bodies = static_cast<double>(request.parts[0].count * worlds);
  const int steps = bodies > 8192 ? 2 : bodies > 512 ? 4 : 8;
  solver->advance(ids, steps * solver->step_size());
  std::vector<double> wall, cpu, part_us;
  const Profile profile = solver->profile();
  for (int k = 0; k < 3; ++k) {
    const Clock clock;
    solver->advance(ids, steps * solver->step_size());
    wall.push_back(1e3 * clock.wall_s() / steps);
    cpu.push_back(1e3 * clock.cpu_s() / steps);
    part_us.push_back(1e3 * cpu.back() / bodies);
  }
  double asleep = 0.0;
  for (const WorldId id : ids)
    for (const bool sleeps : solver->asleep(id)) asleep += sleeps / bodies;
  Row row;
  row.measure("step_ms", wall)
      .measure("step_cpu_ms", cpu)
      .measure("part_cpu_us", part_us)
      .exact("asleep_share", asleep)
      .info("stages_us", stages_of(solver->profile().since(profile), 1e3 / (3.0 * steps * bodies)))
      .info("device", solver->device());
  const auto& counters = solver->profile().counters;
  if (const auto shared = counters.find("gl_bytes_shared"); shared != counters.end())
    row.exact("bytes_a_part", static_cast<double>(counters.at("gl_bytes_held") - shared->second) / bodies);
  return row;
}

struct Point {
  std::size_t per_world, worlds;
};

/// The rows of one curve, as far as the limit lets them get, and the exponents of its cost and memory over x: of all
/// rows of the table, so that one that is measured again counts with those that stay. Of the four largest: small ones
/// are dominated by what every step costs.
void curve(Run& out, const std::string& solver, const std::string& over, const Heap& heap,
           const std::vector<Point>& points) {
  const auto key = [&](const std::string& x) { return Row().key("solver", solver).key("over", over).key("x", x); };
  for (const auto& [per_world, worlds] : points) {
    const std::size_t bodies = heap.rest.size() * per_world * worlds;
    const Row keys = key(std::to_string(points.back().worlds > 1 ? worlds : bodies));
    if (!out.wanted(keys)) continue;
    const Isolated one =
        isolated([&, per_world = per_world, worlds = worlds] { return step_row(heap, solver, per_world, worlds); },
                 out.quick() ? 10.0 : 150.0);
    Row row = Row(keys).info("bodies", bodies).info("worlds", worlds).append(one.row);
    if (one.good) row.measure("peak_mb", one.peak_mb).measure("added_mb", one.added_mb);
    out.row(row);
    if (!one.good) break;  // larger ones would not fit either
  }
  if (!out.wanted(key("exponent"))) return;
  std::vector<double> x, cost, x_of_memory, memory;
  double constant = 0.0;  // MB that the smallest size takes too: parts, fields, what loading took
  for (std::size_t r = 0; r < out.table().rows.size(); ++r) {
    const Row row = out.table().row(r);
    const double at = row.number("x"), step_ms = row.number("step_cpu_ms"), added_mb = row.number("added_mb");
    if (row.at("solver") != solver || row.at("over") != over || std::isnan(at) || std::isnan(step_ms)) continue;
    if (x.empty()) constant = added_mb;
    x.push_back(at);
    cost.push_back(step_ms);
    if (added_mb - constant <= std::max(1.0, 0.1 * constant)) continue;  // lost in what loading took for a while
    x_of_memory.push_back(at);
    memory.push_back(added_mb - constant);
  }
  const auto exponent = [](const std::vector<double>& x, const std::vector<double>& y) {
    const auto skip = static_cast<long>(x.size() > 4 ? x.size() - 4 : 0);
    return fitted_exponent({x.begin() + skip, x.end()}, {y.begin() + skip, y.end()});
  };
  if (x.size() < 2) return;
  Row row = key("exponent").measure("exponent_of_step", exponent(x, cost));
  if (memory.size() > 1) row.measure("exponent_of_memory", exponent(x_of_memory, memory));
  out.row(row);
}

void run(Run& out) {
  const bool quick = out.quick();
  std::vector<std::string> solvers = {"sphere", "sphere/gpu"};
  if (!quick) solvers.insert(solvers.end(), {"bullet", "sphere/thesis"});
  const std::string path = out.scratch() + "/heap.json";
  const Heap large = heap_at_rest(quick ? 16 : 64, path), small = heap_at_rest(16, path);
  std::vector<Point> of_parts, of_worlds;
  for (std::size_t heaps = 1; heaps <= (quick ? 4u : 1024u); heaps *= heaps < 64 ? 2 : 4)
    of_parts.push_back({heaps, 1});
  for (std::size_t worlds = 1; worlds <= (quick ? 4u : 1024u); worlds *= 4) of_worlds.push_back({1, worlds});
  for (const std::string& solver : solvers) {
    // Larger worlds are refused on OpenGL.
    const std::vector<Point> few(of_parts.begin(), of_parts.begin() + std::min<std::size_t>(of_parts.size(), 3));
    curve(out, solver, "parts of one world", large, solver == "sphere/gpu" ? few : of_parts);
    curve(out, solver, "worlds of 16 parts", small, of_worlds);
  }
}

const Registration registration{
    "growth", "cost of a step and memory over parts and worlds, with fitted exponents", {"solver", "over", "x"}, run};

}  // namespace
}  // namespace bin_scenes::bench
