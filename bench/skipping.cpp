/// What is saved by not doing what a scene does not need: each skip off and on, or counted where it has no switch.
#include "framework/benchmark.hpp"
#include "framework/isolated.hpp"
#include "heaps.hpp"
#include "pour/settling.hpp"
#include "without_skips.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes::bench {
namespace {

constexpr const char* part = "channel_u";

/// Step time of eight heaps after they had time to fall asleep, with a share of them woken before every look.
Row sleeping_row(const Heap& heap, const Request& settings, double awake) {
  Heaps heaps(heap, settings, 8, 1);
  const int second = static_cast<int>(std::lround(1.0 / heaps.solver().step_size()));
  heaps.steps(2 * second);
  const double asleep = heaps.asleep();
  std::vector<double> wall, cpu;
  for (int k = 0; k < 5; ++k) {
    heaps.wake(awake);
    const Heaps::Cost cost = heaps.steps(20);
    wall.push_back(cost.wall_ms);
    cpu.push_back(cost.cpu_ms);
  }
  return Row()
      .measure("step_ms", wall)
      .measure("step_cpu_ms", cpu)
      .exact("asleep_before", asleep)
      .info("bodies", heaps.bodies());
}

/// A share of work that was skipped while a scene was poured, from the solver's counters.
void counted(Run& out, const Request& request, const std::string& solver) {
  const char* const skips[] = {"free fall", "recycling", "culling", "reduction", "far contacts"};
  if (std::none_of(std::begin(skips), std::end(skips),
                   [&](const char* skip) { return out.wanted(Row().key("skip", skip).key("solver", solver)); }))
    return;
  const Isolated one = isolated([&] {
    const Poured poured = pour_timed(request);
    Row row;
    for (const auto& [name, n] : poured.scene.report.profile.counters) row.exact(name, n);
    return row;
  });
  const auto share = [&](const std::string& skip, const std::string& what, double skipped, double all) {
    const Row key = Row().key("skip", skip).key("solver", solver).key("state", what);
    if (!(all > 0.0) || std::isnan(skipped) || !out.wanted(key)) return;
    out.row(Row(key).measure("skipped_share", skipped / all));
  };
  const auto n = [&](const char* name) { return one.row.number(name); };
  const double bodies = static_cast<double>(request.part_count());
  share("free fall", "body steps without any contact work", n("body_steps_in_free_fall"), n("steps") * bodies);
  share("recycling", "pairs whose contacts are used again", n("pairs_recycled"), n("pairs"));
  share("culling", "samples never looked at in pairs tested", n("nodes_possible") - n("nodes_tested"),
        n("nodes_possible"));
  share("reduction", "candidates that are no contact of the pair", n("contacts_reduced"),
        n("contacts") + n("contacts_reduced"));
  share("far contacts", "contacts without force that cannot close", n("contacts") - n("contacts_solved"),
        n("contacts"));
  if (!one.good) out.row(Row().key("skip", "counters").key("solver", solver).key("state", "").append(one.row));
}

/// The last second before a scene is at rest and a second more after it.
Row after_rest(const Request& request) {
  const std::vector<PartModelPtr> parts = load_parts(request);
  std::string reason;
  const std::unique_ptr<Solver> solver = make_solver(request, parts, reason);
  const WorldDef def = world_of(request, parts);
  const Scene scene = pour(request, parts, *solver, {0}).front();
  const WorldId world = solver->add_world(def);
  solver->set_phase(world, phases::settle);
  for (std::size_t b = 0; b < scene.parts.size(); ++b) solver->insert(world, b, {scene.parts[b].pose, {}});
  std::vector<double> seconds;
  for (int k = 0; k < 4; ++k) {
    const double begin = cpu_seconds();
    solver->advance({world}, 1.0);
    seconds.push_back(cpu_seconds() - begin);
  }
  return Row()
      .measure("first_second_cpu_s", seconds.front())
      .measure("further_second_cpu_s", {seconds[1], seconds[2], seconds[3]});
}

Row rendering(const Request& request, bool render) {
  Generator generator;
  Generator::Options options;
  options.render = render;
  std::vector<double> seconds;
  for (int k = 0; k < 3; ++k) {
    const double begin = cpu_seconds();
    generator.generate(request, options, [](Generator::Result&&) {});
    seconds.push_back(cpu_seconds() - begin);
  }
  return Row().measure("scene_cpu_s", seconds);
}

void run(Run& out) {
  const std::string path = out.scratch() + "/heap.json";
  isolated([&] { return heap_at_rest(part, 16, path), Row(); });
  const Heap heap = heap_at_rest(part, 16, path);
  const double limit_cpu_s = out.quick() ? 20.0 : 300.0;

  struct Case {
    const char *solver, *state;
    double awake;
    bool sleeping;
  };
  for (const Case& c : {Case{"sphere", "all awake", 1.0, true}, Case{"sphere", "half awake", 0.5, true},
                        Case{"sphere", "all asleep", 0.0, true}, Case{"bullet", "sleeping off", 0.0, false},
                        Case{"bullet", "half awake", 0.5, true}, Case{"bullet", "all asleep", 0.0, true}}) {
    if (out.quick() && c.awake == 0.5) continue;
    const Row key = Row().key("skip", "sleeping").key("solver", c.solver).key("state", c.state);
    if (!out.wanted(key)) continue;
    Request settings = heap.request;
    choose_solver(settings, c.solver);
    settings.solver.bullet.sleeping = c.sleeping;
    const Isolated one = isolated([&] { return sleeping_row(heap, settings, c.awake); }, limit_cpu_s);
    out.row(Row(key).append(one.row));
  }
  for (const char* solver : {"sphere", "bullet"}) {
    const Row key = Row().key("skip", "rest").key("solver", solver).key("state", "seconds after rest");
    if (!out.wanted(key)) continue;
    Request request = bin_of(part, out.quick() ? 8 : 48);
    choose_solver(request, solver);
    const Isolated one = isolated([&] { return after_rest(request); }, limit_cpu_s);
    out.row(Row(key).append(one.row));
  }
  counted(out, bin_of(part, out.quick() ? 8 : 48), "sphere");
  const auto fall = [&](const std::string& skip, const std::string& state, const Skip* without) {
    const Row key = Row().key("skip", skip).key("solver", "sphere").key("state", state);
    if (!out.wanted(key)) return;
    const Isolated one =
        isolated([&] { return fall_row(part, out.quick() ? 8 : 64, out.quick() ? 0.5 : 2.0, without); }, limit_cpu_s);
    out.row(Row(key).append(one.row));
  };
  fall("none", "parts fall and settle", nullptr);
  for (const Skip& skip : pass_skips()) fall(skip.name, skip.off, &skip);
  for (const bool render : {true, false}) {
    const Row key = Row()
                        .key("skip", "rendering")
                        .key("solver", "sphere")
                        .key("state", render ? "a camera is read" : "nobody looks");
    if (!out.wanted(key)) continue;
    Request request = bin_of(part, 4);
    request.sensors.emplace_back();
    const Isolated one = isolated([&] { return rendering(request, render); }, limit_cpu_s);
    out.row(Row(key).append(one.row));
  }
}

const Registration registration{
    "skipping",
    "what each skip saves: sleeping, rest, free fall, recycling, culling, far contacts, rendering",
    {"skip", "solver", "state"},
    run};

}  // namespace
}  // namespace bin_scenes::bench
