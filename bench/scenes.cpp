/// The main job as a user asks for it: scene time, memory and the errors of the final scene, both solvers, over counts,
/// shapes and seeds.
#include "framework/benchmark.hpp"
#include "runs.hpp"

namespace bin_scenes::bench {
namespace {

void run(Run& out) {
  const std::vector<std::size_t> counts =
      out.quick() ? std::vector<std::size_t>{16} : std::vector<std::size_t>{64, 256, 512};
  for (const std::size_t count : counts) {
    for (const char* part : {"bolt_hex", "conrod", "pipe_tee"}) {
      for (const char* solver : {"sphere", "bullet"}) {
        Request request = bin_of(part, count);
        choose_solver(request, solver);
        const bool many = count > 256 || (count > 64 && request.solver.type == SolverType::bullet);
        const int seeds = out.quick() || many ? 1 : 3;
        const Row key = Row().key("part", part).key("bodies", count).key("solver", solver).key("sleeping", "yes");
        if (!out.wanted(key)) continue;
        const double limit_cpu_s = request.solver.type == SolverType::bullet ? 600.0 : 150.0;
        out.row(Row(key).append(over_seeds(request, seeds, out.quick() ? 20.0 : limit_cpu_s)));
      }
    }
  }
}

const Registration registration{"scenes",
                                "time, memory and errors of whole scenes: three parts, both solvers, 64 to 512",
                                {"part", "bodies", "solver", "sleeping"},
                                run};

}  // namespace
}  // namespace bin_scenes::bench
