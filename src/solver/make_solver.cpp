#include "bin_scenes/core/error.hpp"
#include "bin_scenes/gl/device.hpp"
#include "bin_scenes/solver/bullet_solver.hpp"
#include "bin_scenes/solver/solver.hpp"
#include "bin_scenes/solver/thesis_solver.hpp"
#include "sphere/sphere_solver.hpp"
#include "sphere_gl/gl_sphere_solver.hpp"

namespace bin_scenes {

namespace {

/// Whether the sphere solver's passes run on the GPU; says why. Under a software GL they are much slower than the same
/// passes in C++ (docs/develop/gpu.md).
bool on_gpu(const SphereSettings& settings, std::size_t bodies, std::string& reason) {
  if (settings.device != SphereSettings::Device::automatic) return settings.device == SphereSettings::Device::gpu;
  if (bodies > most_gl_bodies()) {
    reason += "; on the CPU: more bodies than the GPU's form takes";
    return false;
  }
  try {
    if (gl::Device::hardware_listed() && !gl::Device::current().software()) {
      reason += "; on the GPU";
      return true;
    }
  } catch (const Error&) {
  }
  reason += "; on the CPU: no hardware OpenGL device";
  return false;
}

std::unique_ptr<Solver> make_sphere(const Request& request, std::string& reason) {
  const SolverSettings& settings = request.solver;
  if (settings.preset == SolverSettings::Preset::thesis) return std::make_unique<ThesisSolver>(settings.thesis);
  const std::size_t bodies = request.part_count() + (request.bin.kind == Bin::Kind::mesh ? 1 : 0);
  if (!on_gpu(settings.sphere, bodies, reason)) return make_sphere_solver(settings.sphere);
  sphere_gl::Capacity capacity;
  capacity.bodies = bodies;
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
