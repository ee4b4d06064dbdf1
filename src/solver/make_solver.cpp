#include "bin_scenes/solver/bullet_solver.hpp"
#include "bin_scenes/solver/solver.hpp"
#include "bin_scenes/solver/thesis_solver.hpp"
#include "sphere/sphere_solver.hpp"

namespace bin_scenes {

namespace {

std::unique_ptr<Solver> make_sphere(const SolverSettings& settings) {
  if (settings.preset == SolverSettings::Preset::thesis) return std::make_unique<ThesisSolver>(settings.thesis);
  return make_sphere_solver(settings.sphere);
}

}  // namespace

std::unique_ptr<Solver> make_solver(const Request& request, const std::vector<PartModelPtr>&, std::string& reason) {
  switch (request.solver.type) {
    case SolverType::sphere:
      reason = "asked for";
      return make_sphere(request.solver);
    case SolverType::bullet:
      reason = "asked for";
      return make_bullet_solver(request.solver.bullet);
    case SolverType::automatic:
      break;
  }
  // Bullet needs a convex decomposition first, and its cost grows with the hulls of each touching pair squared. A cost
  // model by device, part and count awaits the benchmarks.
  reason = "auto: sphere, which takes any concave part without convex decomposition";
  return make_sphere(request.solver);
}

}  // namespace bin_scenes
