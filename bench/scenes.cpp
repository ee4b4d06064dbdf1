/// The main job as a user asks for it: scene time, memory and the errors of the final scene, both solvers, over counts,
/// shapes and seeds.
#include "framework/benchmark.hpp"
#include "judged.hpp"

namespace bin_scenes::bench {
namespace {

void run(Run& out) {
  const std::vector<std::size_t> counts = {64, 256, 512};
  for (const std::size_t count : out.quick() ? std::vector<std::size_t>{16} : counts)
    for (const char* part : {"bolt_hex", "conrod", "pipe_tee"})
      for (const std::string solver : {"sphere", "bullet"}) {
        const Row key = Row::keys("part", part, "bodies", count, "solver", solver, "sleeping", "yes");
        if (!out.wanted(key)) continue;
        const bool bullet = solver == "bullet", many = count > 256 || (count > 64 && bullet);
        Request request = bin_of(part, count);
        choose_solver(request, solver);
        warm_up(request);
        const Judged how{out.quick() ? 20.0 : bullet ? 600.0 : 150.0, 0};
        out.row(
            Row(key).append(joined(judged_scenes(out.scratch(), request, {}, {}, how, out.quick() || many ? 1 : 3))));
      }
}

const Registration registration{"scenes",
                                "time, memory and errors of whole scenes: three parts, both solvers, 64 to 512",
                                {"part", "bodies", "solver", "sleeping"},
                                run};

}  // namespace
}  // namespace bin_scenes::bench
