#include "bin_scenes/solver/bullet_solver.hpp"
#include "bin_scenes/solver/solver.hpp"

#include "bin_scenes/core/error.hpp"

namespace bin_scenes {

std::unique_ptr<Solver> make_solver(const Request& request, const std::vector<PartModelPtr>&, std::string& reason) {
  switch (request.solver.type) {
    case SolverType::sphere:
      throw environment_error("this build has no sphere solver", "solver.type", "use solver.type: bullet");
    case SolverType::automatic:
      reason = "auto: bullet, the only solver of this build";
      break;
    case SolverType::bullet:
      reason = "asked for";
      break;
  }
  return make_bullet_solver(request.solver.bullet);
}

}  // namespace bin_scenes
