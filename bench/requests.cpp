#include "requests.hpp"

#include "bin_scenes/core/error.hpp"
#include "framework/benchmark.hpp"

#include <cmath>

namespace bin_scenes::bench {

Request bin_of(const std::string& part, std::size_t count) {
  Request request;
  PartLine line;
  line.model = part + ".stl";
  line.path = Run::part(part);
  line.unit = Unit::millimetre;
  line.count = count;
  line.density = 7850.0;
  request.parts.push_back(line);
  const double side = std::sqrt(static_cast<double>(count) / 150.0);
  request.bin.inner_size = Vec3(0.40 * side, 0.30 * side, 0.20);
  request.seed = 1;
  return request;
}

void choose_solver(Request& request, const std::string& name) {
  if (name == "bullet") {
    request.solver.type = SolverType::bullet;
  } else if (name == "sphere/quick") {
    request.solver.type = SolverType::sphere;
    apply(SolverSettings::Preset::quick, request);
  } else if (name == "sphere" || name == "sphere/gpu" || name == "sphere/thesis") {
    request.solver.type = SolverType::sphere;
    request.solver.preset = name == "sphere/thesis" ? SolverSettings::Preset::thesis : SolverSettings::Preset::standard;
    if (name == "sphere/gpu") request.solver.sphere.device = SphereSettings::Device::gpu;
  } else {
    throw input_error("no solver is called '" + name + "'", "benchmark", "sphere, sphere/quick, sphere/gpu, sphere/thesis or bullet");
  }
}

}  // namespace bin_scenes::bench
