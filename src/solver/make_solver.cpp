#include "bin_scenes/solver/bullet_solver.hpp"
#include "bin_scenes/solver/solver.hpp"
#include "bin_scenes/solver/thesis_solver.hpp"
#include "solver/device_choice.hpp"
#include "solver/sphere/sphere_solver.hpp"
#include "solver/sphere_gl/gl_sphere_solver.hpp"

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

std::unique_ptr<Solver> make_sphere(const Request& request, std::string& reason) {
  const SolverSettings& settings = request.solver;
  if (settings.preset == SolverSettings::Preset::thesis) return std::make_unique<ThesisSolver>(settings.thesis);
  const std::size_t bodies = request.part_count() + (request.bin.kind == Bin::Kind::mesh ? 1 : 0);
  if (!on_gpu(request, reason)) return make_sphere_solver(settings.sphere);
  sphere_gl::Capacity capacity;
  capacity.bodies = bodies;
  capacity.memory = 0.25 * request.memory_budget;  // the rest: this process, models, scenes that wait, images
  return make_gl_sphere_solver(settings.sphere, capacity);
}

}  // namespace

std::unique_ptr<Solver> make_solver(const Request& request, const std::vector<PartModelPtr>&, std::string& reason) {
  switch (request.solver.type) {
    case SolverType::sphere:
      reason = "asked for";
      return make_sphere(request, reason);
    case SolverType::bullet:
      reason = "asked for";
      return make_bullet_solver(request.solver.bullet);
    case SolverType::automatic:
      break;
  }
  // Measured from 1 part to 64, convex and concave: Bullet never was the cheaper one, so only the device is left to
  // choose.
  reason = "auto: sphere, as cheap as bullet or cheaper for every part and count measured (docs/use/choosing.md)";
  return make_sphere(request, reason);
}

}  // namespace bin_scenes
