#include "bin_scenes/solver/bullet_solver.hpp"
#include "bin_scenes/solver/solver.hpp"
#include "bin_scenes/solver/thesis_solver.hpp"
#include "solver/device_choice.hpp"
#include "solver/sphere/sphere_solver.hpp"
#include "solver/sphere_gl/gl_sphere_solver.hpp"

#include <algorithm>
#include <set>

namespace bin_scenes {

namespace {

/// Whether the sphere solver's passes run on the GPU; says why.
bool on_gpu(const Request& request, std::string& reason) {
  const SphereSettings::Device asked = request.solver.sphere.device;
  if (asked != SphereSettings::Device::automatic) return asked == SphereSettings::Device::gpu;
  const DeviceChoice choice = choose_device(request);
  reason += "; " + choice.reason;
  return choice.gpu;
}

std::unique_ptr<Solver> make_sphere(const LoadedRequest& loaded, std::string& reason) {
  const Request& request = loaded.request;
  SolverSettings settings = request.solver;
  if (settings.preset == SolverSettings::Preset::thesis) return std::make_unique<ThesisSolver>(settings.thesis);
  const std::size_t bodies = request.part_count() + (request.bin.kind == Bin::Kind::mesh ? 1 : 0);
  settings.sphere.field_nodes = field_nodes_that_fit(loaded);
  if (!on_gpu(request, reason)) return make_sphere_solver(settings.sphere);
  sphere_gl::Capacity capacity;
  capacity.bodies = bodies;
  capacity.memory = 0.25 * request.memory_budget;  // the rest: this process, models, scenes that wait, images
  return make_gl_sphere_solver(settings.sphere, capacity);
}

}  // namespace

std::size_t field_nodes_that_fit(const LoadedRequest& loaded) {
  constexpr double fewest = 1e5;  // as many as of a cell of 1.3 % of a cube's diagonal
  const std::size_t most = loaded.request.solver.sphere.field_nodes;
  const std::size_t models = std::set<PartModelPtr>(loaded.parts.begin(), loaded.parts.end()).size();
  if (models == 0) return most;
  const double share = 0.5 * loaded.request.memory_budget / static_cast<double>(models * sizeof(float));
  return static_cast<std::size_t>(std::clamp(share, fewest, static_cast<double>(most)));
}

std::unique_ptr<Solver> make_solver(const LoadedRequest& loaded, std::string& reason) {
  switch (loaded.request.solver.type) {
    case SolverType::sphere:
      reason = "asked for";
      return make_sphere(loaded, reason);
    case SolverType::bullet:
      reason = "asked for";
      return make_bullet_solver(loaded.request.solver.bullet);
    case SolverType::automatic:
      break;
  }
  // Measured from 1 part to 64, convex and concave: Bullet never was the cheaper one, so only the device is left to
  // choose.
  reason = "auto: sphere, as cheap as bullet or cheaper for every part and count measured (docs/use/choosing.md)";
  return make_sphere(loaded, reason);
}

}  // namespace bin_scenes
