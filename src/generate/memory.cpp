#include "bin_scenes/core/error.hpp"
#include "bin_scenes/generate/generator.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

namespace bin_scenes {

namespace {

// Bytes by order of magnitude: the estimate has to catch requests that cannot fit, not to count to the last byte.
constexpr double kPerTriangle = 400.0;       // mesh, tree over it, copies on the device
constexpr double kPerBody = 2000.0;          // state, definition, history of rest, report
constexpr double kPerSample = 64.0;          // contact sample or sphere with its normal
constexpr double kContactsPerBody = 8 * 12;  // touching neighbours times contacts kept with each
constexpr double kPerContact = 160.0;
constexpr double kPerPixel = 64.0;  // depth, label, normal, intensity, and the cloud while it is written

double field_bytes(const PartModel& part, double relative_cell) {
  const Vec3 cells = part.mesh().bounds().size() / (relative_cell * part.diagonal());
  const double nodes = (cells.array() + 7.0).prod();
  return sizeof(float) * std::min(nodes, static_cast<double>(FieldOptions().max_nodes));
}

double model_bytes(const Request& request, const PartModel& part) {
  const SolverSettings& solver = request.solver;
  double bytes = kPerTriangle * static_cast<double>(part.mesh().triangles.size());
  if (solver.type == SolverType::bullet) return bytes + kPerTriangle * 128.0 * solver.bullet.max_hulls;
  if (solver.preset == SolverSettings::Preset::thesis) return bytes;
  return bytes + field_bytes(part, solver.sphere.field_cell) + kPerSample * solver.sphere.fine_samples;
}

double body_bytes(const Request& request) {
  const SolverSettings& solver = request.solver;
  if (solver.type == SolverType::bullet || solver.preset == SolverSettings::Preset::standard) {
    return kPerBody + kContactsPerBody * kPerContact;
  }
  const double spheres = 6.0 * std::pow(solver.thesis.voxels / solver.thesis.tightness, 2);
  return kPerBody + spheres * (kPerSample + 16.0 * solver.thesis.contacts_per_sphere);
}

std::string in_megabytes(double bytes) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.0f MB", std::ceil(bytes / 1e6));
  return text;
}

}  // namespace

double estimate_memory(const Request& request, const std::vector<PartModelPtr>& parts) {
  const double bodies = body_bytes(request) * static_cast<double>(request.part_count());
  double pixels = 0.0;
  for (const Sensor& sensor : request.sensors) pixels += kPerPixel * sensor.width * static_cast<double>(sensor.height);
  double models = 0.0;
  for (const PartModelPtr& part : std::set<PartModelPtr>(parts.begin(), parts.end())) {
    models += model_bytes(request, *part);
  }
  double grid = 0.0;
  if (request.solver.type == SolverType::sphere && request.solver.preset == SolverSettings::Preset::thesis) {
    grid = 8.0 * std::pow(request.solver.thesis.grid_size, 3);
  }
  const double total = bodies + pixels + models + grid;
  if (total > request.memory_budget) {
    throw input_error("the request needs about " + in_megabytes(total) + " (parts " + in_megabytes(bodies) +
                          ", models " + in_megabytes(models) + ", grid " + in_megabytes(grid) + ", images " +
                          in_megabytes(pixels) + "), the budget is " + in_megabytes(request.memory_budget),
                      "memory_budget", "ask for fewer parts or pixels, or raise memory_budget");
  }
  return total;
}

}  // namespace bin_scenes
