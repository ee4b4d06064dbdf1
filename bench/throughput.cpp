/// How fast scenes come: one alone, and many in one run. Simulation alone first, then the whole job with judging.
#include "framework/benchmark.hpp"
#include "framework/isolated.hpp"
#include "runs.hpp"

#include <numeric>

namespace bin_scenes::bench {
namespace {

Row timed(Request request, std::size_t scenes) {
  request.scenes = scenes;
  const LoadedRequest all = loaded(request);
  std::vector<std::size_t> indices(scenes);
  std::iota(indices.begin(), indices.end(), std::size_t{0});
  double simulation_s = 0.0;
  {
    const std::unique_ptr<Solver> solver = solver_of(all);
    pour(all, *solver, {scenes});  // another scene: programs are compiled, buffers have their size
    const Clock clock;
    pour(all, *solver, indices);
    simulation_s = clock.wall_s();
  }
  Generator generator;
  Generator::Options options;
  options.render = false;
  double judging_ms = 0.0;
  std::size_t accepted = 0;
  const Clock clock;
  generator.generate(request, options, [&](Generator::Result&& result) {
    const Report& report = result.scene.report;
    accepted += report.accepted ? 1 : 0;
    const auto quality = report.profile.stages_ms.find("quality");
    if (quality != report.profile.stages_ms.end()) judging_ms += quality->second;
  });
  const double whole_s = clock.wall_s();
  const auto count = static_cast<double>(scenes);
  return Row()
      .measure("simulation_s", simulation_s)
      .measure("whole_s", whole_s)
      .measure("whole_cpu_s", clock.cpu_s())
      .measure("judging_ms", judging_ms / count)
      .exact("accepted", accepted)
      .measure("accepted_per_s", static_cast<double>(accepted) / whole_s);
}

void run(Run& out) {
  const std::size_t parts = out.quick() ? 12 : 256;
  const std::vector<std::size_t> counts = {1, 16, 512}, few = {1, 4};
  for (const char* solver : {"sphere/gpu", "sphere"})
    for (const std::size_t scenes : out.quick() ? few : counts) {
      const Row key = Row::keys("solver", solver, "bodies", parts, "scenes", scenes);
      if (!out.wanted(key)) continue;
      Request request = bin_of("conrod", parts);
      warm_up(request, "sphere");
      choose_solver(request, solver);
      out.row(Row(key).append(isolated([&] { return timed(request, scenes); }, 7200.0).row));
    }
}

const Registration registration{
    "throughput", "accepted scenes a second: 1, 16 and 512 in one run", {"solver", "bodies", "scenes"}, run};

}  // namespace
}  // namespace bin_scenes::bench
