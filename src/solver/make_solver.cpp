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
  // docs/solver.md: at every count and for every part measured it is the faster and the more accurate of the two, and
  // it needs no convex decomposition, which alone takes longer than a scene.
  reason = "auto: sphere is faster and more accurate than bullet at every part and count measured (docs/solver.md)";
  return make_sphere(request.solver);
}

}  // namespace bin_scenes
