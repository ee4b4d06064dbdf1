/// What each pass of the GPU form costs on a card, counted without one (test/meter): one world of connecting rods in
/// each phase of a pour, and the mean over a whole pour; and the thesis preset's teapots. `meter_lines`: the same by
/// line of source, for --rows pass=NAME alone, as a table of all lines is of no use.
///
/// Figures are per world and step. Passes are whatever was dispatched.
#include "framework/benchmark.hpp"
#include "framework/isolated.hpp"
#include "runs.hpp"

#include "bin_scenes/config/request_reader.hpp"
#include "bin_scenes/output/scene_writer.hpp"
#include "bin_scenes/solver/thesis_solver.hpp"
#include "meter/watch.hpp"
#include "pour/settling.hpp"
#include "solver/sphere_gl/gl_sphere_solver.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>

namespace bin_scenes::bench {
namespace {

using meter::Counts;
using meter::Watch;

struct Case {
  std::string phase;
  std::size_t world_group, pair_group;  ///< invocations; 0: there is no choice
};

Row keys_of(const Case& of) {
  return Row::keys("phase", of.phase, "world_group", of.world_group, "pair_group", of.pair_group);
}

/// What was seen, and over how many steps of a world.
struct Seen {
  std::map<std::string, Counts> passes;
  double steps = 1;
  meter::Card card;
};

/// Advances one step now and then while it is watched; hands everything else on to a solver.
class Sampled final : public Solver {
 public:
  Sampled(std::unique_ptr<Solver> solver, Watch& watch, unsigned every)
      : solver_(std::move(solver)), watch_(watch), every_(every) {}

  double advance(const std::vector<WorldId>& worlds, double seconds) override {
    if (++slices_ % every_ != 0) return solver_->advance(worlds, seconds);
    const std::uint64_t before = steps(worlds.front());
    watch_.begin();
    const double first = solver_->advance(worlds, std::min(seconds, step_size()));
    watch_.end();
    watched_ += static_cast<double>(steps(worlds.front()) - before);
    return first < seconds ? first + solver_->advance(worlds, seconds - first) : first;
  }
  double watched() const { return watched_; }

  WorldId add_world(const WorldDef& def) override { return solver_->add_world(def); }
  void remove_world(WorldId world) override { solver_->remove_world(world); }
  void insert(WorldId world, std::size_t body, const BodyState& state) override { solver_->insert(world, body, state); }
  void remove(WorldId world, std::size_t body) override { solver_->remove(world, body); }
  bool set_phase(WorldId world, const Phase& phase) override { return solver_->set_phase(world, phase); }
  std::vector<BodyState> states(WorldId world) const override { return solver_->states(world); }
  std::vector<bool> asleep(WorldId world) const override { return solver_->asleep(world); }
  double step_size() const override { return solver_->step_size(); }
  std::uint64_t steps(WorldId world) const override { return solver_->steps(world); }
  const Profile& profile() const override { return solver_->profile(); }
  std::vector<Flag> flags(WorldId world) const override { return solver_->flags(world); }
  std::string name() const override { return solver_->name(); }
  std::string device() const override { return solver_->device(); }

 private:
  std::unique_ptr<Solver> solver_;
  Watch& watch_;
  unsigned every_, slices_ = 0;
  double watched_ = 0;
};

Phase phase_of(const std::string& name) {
  return name == "settle" ? phases::settle : name == "press" ? phases::press : phases::probe;
}

sphere_gl::Capacity capacity_of(const Case& of, std::size_t bodies) {
  sphere_gl::Capacity capacity;
  capacity.world_group = of.world_group;
  capacity.pair_group = of.pair_group;
  capacity.bodies = bodies;
  capacity.as_on_card = true;
  return capacity;
}

/// The step after `before` others of a heap that is put into a phase.
Seen seen_step(const LoadedRequest& all, const std::vector<ScenePart>& heap, const Case& of, int before) {
  Watch watch;
  const std::unique_ptr<Solver> solver = make_gl_sphere_solver(all.request.solver.sphere, capacity_of(of, heap.size()));
  const WorldId id = solver->add_world(world_of(all));
  solver->set_phase(id, phase_of(of.phase));
  for (std::size_t i = 0; i < heap.size(); ++i) solver->insert(id, i, {heap[i].pose, {}});
  solver->advance({id}, before * solver->step_size());
  const std::uint64_t start = solver->steps(id);
  watch.begin();
  solver->advance({id}, solver->step_size());
  watch.end();
  return {watch.passes(), static_cast<double>(solver->steps(id) - start), watch.card()};
}

/// Steps of a whole pour, one in `every` slices of 1/60 s.
Seen seen_pour(const LoadedRequest& all, const Case& of, unsigned every) {
  Watch watch;
  Sampled solver(make_gl_sphere_solver(all.request.solver.sphere, capacity_of(of, all.request.parts[0].count)), watch,
                 every);
  pour(all, solver, {0});
  return {watch.passes(), solver.watched(), watch.card()};
}

/// Steps of the thesis preset, one in `every` slices of so many simulated seconds.
Seen seen_thesis(LoadedRequest all, double seconds, unsigned every) {
  Watch watch;
  Sampled solver(solver_of(all), watch, every);
  all.request.seconds = seconds;
  pour(all, solver, {0});
  return {watch.passes(), solver.watched(), watch.card()};
}

Row figures_of(const Counts& c, const Seen& seen) {
  const double steps = std::max(1.0, seen.steps), groups = std::max<double>(1, static_cast<double>(c.groups));
  const auto a_step = [&](auto count) { return static_cast<double>(count) / steps; };
  Row row;
  row.measure("dispatches", a_step(c.dispatches)).measure("groups", a_step(c.groups));
  row.measure("slots_k", a_step(c.slots) / 1e3).measure("lanes", c.lanes());
  row.measure("loaded_sectors", a_step(c.sectors.loaded)).measure("stored_sectors", a_step(c.sectors.stored));
  row.measure("l1_hits_rel", c.l1_share()).measure("l2_mb", a_step(c.l2_bytes()) / 1e6);
  row.measure("atomics", a_step(c.atomics)).measure("barriers_a_group", static_cast<double>(c.barriers) / groups);
  row.measure("divergent_rel", c.branches ? static_cast<double>(c.divergent) / static_cast<double>(c.branches) : 0.0);
  row.measure("latency_kcycles", c.latency / groups / 1e3).measure("longest_kcycles", c.longest / 1e3);
  row.measure("alone_us", a_step(c.dispatch_us));
  row.measure("issue_264_us", meter::full_issue_us(a_step(c.slots), 264, seen.card));
  row.measure("code_kb", c.code_bytes / 1e3).measure("shared_kb", 4e-3 * c.shared_words);
  return row;
}

/// Sums over passes; what is of one program or group has none.
Row sums_of(const Seen& seen) {
  Counts all;
  for (const auto& [name, counts] : seen.passes) {
    all.slots += counts.slots;
    all.lane_slots += counts.lane_slots;
    all.dispatches += counts.dispatches;
    all.groups += counts.groups;
    all.l1_hits += counts.l1_hits;
    all.sectors.loaded += counts.sectors.loaded;
    all.sectors.stored += counts.sectors.stored;
    all.atomics += counts.atomics;
    all.dispatch_us += counts.dispatch_us;
  }
  const Row figures = figures_of(all, seen);
  Row row;
  for (const auto& [column, value] : figures.cells())
    for (const char* sum : {"dispatches", "groups", "slots_k", "lanes", "loaded_sectors", "stored_sectors",
                            "l1_hits_rel", "l2_mb", "atomics", "alone_us", "issue_264_us"})
      if (column.name == sum) row.add(column, value);
  return row.info("steps", seen.steps);
}

Table table_of_passes(const Case& of, const Seen& seen) {
  Table table;
  for (const auto& [name, counts] : seen.passes)
    table.add(keys_of(of).key("pass", name).append(figures_of(counts, seen)));
  table.add(keys_of(of).key("pass", "all").append(sums_of(seen)));
  return table;
}

/// Those that take at least a thousandth of their pass.
Table table_of_lines(const Case& of, const Seen& seen) {
  Table table;
  for (const auto& [name, counts] : seen.passes)
    for (const auto& [line, cost] : counts.lines)
      if (cost.slots > 1e-3 * counts.slots)
        table.add(keys_of(of)
                      .key("pass", name)
                      .key("line", line)
                      .measure("slots_k", cost.slots / std::max(1.0, seen.steps) / 1e3)
                      .measure("share_rel", cost.slots / counts.slots)
                      .measure("lanes", cost.lane_slots / cost.slots));
  return table;
}

using MakeTable = Table (*)(const Case&, const Seen&);

/// In a process of its own, as benchmarks that follow may fork.
void add_rows(Run& out, const Case& of, MakeTable make, const std::function<Seen()>& see) {
  if (!out.wanted(keys_of(of))) return;
  const std::string path = out.scratch() + "/rows.csv";
  const auto work = [&] {
    write_text(path, to_csv(make(of, see())));
    return Row();
  };
  const Isolated done = isolated(work, 7200.0);
  if (!done.good) return out.row(keys_of(of).append(done.row));
  const Table table = read_csv(path);
  for (std::size_t k = 0; k < table.rows.size(); ++k)
    if (out.wanted(table.row(k))) out.row(table.row(k));
}

void run_rods(Run& out, MakeTable make) {
  Request request = bin_of("conrod", out.quick() ? 12 : 256);
  request.bin.inner_size = Vec3(0.40, 0.30, 0.20);  // m, as in config/conrods.yaml
  choose_solver(request, "sphere");
  const std::string path = out.scratch() + "/heap.json";
  bool poured = false;
  for (const std::size_t world_group : {256, 64})
    for (const char* phase : {"settle", "press", "probe", "pour"}) {
      const Case of{phase, world_group, 32};
      const bool whole = of.phase == "pour";
      if (!whole && !poured && out.wanted(keys_of(of))) pour_into(path, request), poured = true;
      add_rows(out, of, make, [&] {
        const LoadedRequest all = loaded(request);
        return whole ? seen_pour(all, of, out.quick() ? 40 : 5) : seen_step(all, read_scene_json(path).parts, of, 4);
      });
    }
}

/// config/thesis_teapots.yaml with five iterations, as bench/gpu.sh runs it.
void run_teapots(Run& out, MakeTable make) {
  const Case of{"thesis", 0, 0};
  add_rows(out, of, make, [&] {
    const std::filesystem::path models = std::filesystem::path(Run::part("teapot")).parent_path();
    Request request = read_request((models / "../config/thesis_teapots.yaml").string());
    request.solver.thesis.iterations = 5;
    if (out.quick()) request.parts[0].count = 12;
    return seen_thesis(loaded(request), out.quick() ? 0.2 : 2.05, out.quick() ? 10 : 60);
  });
}

void run(Run& out) {
  run_rods(out, table_of_passes);
  run_teapots(out, table_of_passes);
}

void run_lines(Run& out) {
  run_rods(out, table_of_lines);
  run_teapots(out, table_of_lines);
}

const std::vector<std::string> keys = {"phase", "world_group", "pair_group", "pass"};
const Registration passes{"meter", "cost of each pass on a card, counted without one", keys, run,
                          "src/solver/sphere_gl shaders"};
const Registration lines{"meter_lines",
                         "the same by line of source: choose a pass with --rows",
                         {"phase", "world_group", "pair_group", "pass", "line"},
                         run_lines};

}  // namespace
}  // namespace bin_scenes::bench
