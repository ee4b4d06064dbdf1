/// Estimates the bytes of models, bodies, pairs and images from counts, before anything large is allocated. Where a
/// model is not loaded yet, a usual one stands for it.
#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/generate/generator.hpp"
#include "bin_scenes/sensor/image_settings.hpp"
#include "bin_scenes/sensor/sensor_model.hpp"
#include "bin_scenes/solver/solver.hpp"

#include "core/formatted.hpp"
#include "generate/finishing.hpp"

#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace bin_scenes {

namespace {

// Bytes, set by the peak of whole runs (heaps of 64 to 2000 parts, on llvmpipe): the estimate has to catch requests
// that cannot fit, not to count to the last byte.
constexpr double program_bytes = 60e6;        // the tool with its libraries and threads
constexpr double device_bytes = 75e6;         // an OpenGL context; of a software device, which lives in this process
constexpr double per_waiting_part = 500.0;    // of a scene that waits to be finished: pose, name, report
constexpr double per_triangle = 400.0;        // mesh, tree over it, tree for rays, copies on the device
constexpr double per_body = 2000.0;           // state, definition, history of rest, report
constexpr double per_sample = 64.0;           // contact sample with its normal
constexpr double contacts_per_body = 8 * 12;  // touching neighbours times contacts kept with each
constexpr double per_contact = 160.0;
constexpr double per_hull = 9000.0;           // of a body: Bullet keeps a manifold for each pair of hulls that are near
constexpr double per_pair = 200.0;            // of parts that start within each other
constexpr double per_bullet_pair = 7500.0;    // likewise: Bullet makes a manifold and its constraints for each
constexpr double per_sphere = 120.0;          // of the thesis's solver, its share of grid and sorting included
constexpr double per_sphere_contact = 24.0;   // of its capacity
constexpr double per_pixel = 120.0;           // view, measured and true images, and a cloud that is being written
constexpr double per_denoised_pixel = 170.0;  // light, its variance and its faces, before and after a pass

double field_bytes(const PartModel& part, double relative_cell, std::size_t most_nodes) {
  const Vec3 cells = part.mesh().bounds().size() / (relative_cell * part.diagonal());
  const double nodes = (cells.array() + 7.0).prod();
  return sizeof(float) * std::min(nodes, static_cast<double>(most_nodes));
}

double model_bytes(const Request& request, const PartModel& part, std::size_t field_nodes) {
  const SolverSettings& solver = request.solver;
  const double shape =
      field_bytes(part, solver.sphere.field_cell, field_nodes) + per_sample * solver.sphere.fine_samples;
  // Proofs have a solver of their own.
  const double bytes =
      per_triangle * static_cast<double>(part.mesh().triangles.size()) + (request.prove > 0 ? shape : 0.0);
  if (solver.type == SolverType::bullet) return bytes + per_triangle * 128.0 * solver.bullet.max_hulls;
  if (solver.preset == SolverSettings::Preset::thesis) return bytes;
  return bytes + shape;
}

double hulls_of(const Request& request, const PartModel& part) {
  HullOptions options;  // the solver needs the same hulls next
  options.max_error = request.solver.bullet.hull_error;
  options.max_volume_error = request.solver.bullet.hull_volume_error;
  options.max_hulls = request.solver.bullet.max_hulls;
  return static_cast<double>(part.hulls(options).hulls.size());
}

/// One body of this part; null: one of a part that is not loaded yet.
double body_bytes(const Request& request, const PartModel* part) {
  const SolverSettings& solver = request.solver;
  if (solver.type == SolverType::bullet) {
    return per_body + per_hull * (part ? hulls_of(request, *part) : 1.0);
  }
  if (solver.preset != SolverSettings::Preset::thesis) return per_body + contacts_per_body * per_contact;
  const ThesisSettings& thesis = solver.thesis;
  const double across = thesis.radii.empty() ? thesis.voxels : 0.5 / thesis.radii.back();
  const double spheres = 6.0 * std::pow(across / thesis.tightness, 2);
  return per_body + spheres * (per_sphere + per_sphere_contact * solver.thesis.contacts_per_sphere);
}

/// Of the pairs of parts that start within each other, by their boxes at the poses they are given; stops above `most`.
double overlap_bytes(const LoadedRequest& loaded, double most) {
  const Request& request = loaded.request;
  const std::vector<PartModelPtr>& parts = loaded.parts;
  struct Placed {
    Aabb box;
    double hulls;
  };
  const bool bullet = request.solver.type == SolverType::bullet;
  std::vector<Placed> placed;
  Aabb all;
  for (std::size_t line = 0; line < std::min(parts.size(), request.parts.size()); ++line) {
    const Aabb box = parts[line]->mesh().bounds();
    const double hulls = bullet && !request.parts[line].poses.empty() ? hulls_of(request, *parts[line]) : 1.0;
    for (const Pose& pose : request.parts[line].poses) {
      const Vec3 center = pose * box.center();
      const Vec3 half = pose.orientation.toRotationMatrix().cwiseAbs() * (0.5 * box.size());
      placed.push_back({{}, hulls});
      placed.back().box.extend(Vec3(center - half));
      placed.back().box.extend(Vec3(center + half));
      all.extend(center);
    }
  }
  if (placed.empty()) return 0.0;
  int axis;
  all.size().maxCoeff(&axis);
  std::sort(placed.begin(), placed.end(),
            [&](const Placed& a, const Placed& b) { return a.box.lower[axis] < b.box.lower[axis]; });
  double bytes = 0.0,
         pairs_left = 1e8;  // half a second: where so many are beside each other, few are within each other
  for (std::size_t i = 0; i < placed.size(); ++i) {
    const Placed& a = placed[i];
    for (std::size_t j = i + 1; j < placed.size() && placed[j].box.lower[axis] <= a.box.upper[axis]; ++j) {
      if (--pairs_left < 0.0) return bytes;
      const Placed& b = placed[j];
      if (!a.box.overlaps(b.box)) continue;
      const Vec3 shared = a.box.upper.cwiseMin(b.box.upper) - a.box.lower.cwiseMax(b.box.lower);
      const double smaller = std::min(a.box.size().prod(), b.box.size().prod());
      const double share = smaller > 0.0 ? std::min(1.0, shared.cwiseMax(0.0).prod() / smaller) : 1.0;
      // In one place a hull meets 3.5 of the other part (64 hulls of a mug; measured).
      bytes += bullet ? per_bullet_pair * (1.0 + share * (1.75 * (a.hulls + b.hulls) - 3.5)) : per_pair;
      if (bytes > most) return bytes;
    }
  }
  return bytes;
}

std::string in_megabytes(double bytes) {
  return formatted("%.0f MB", std::ceil(bytes / 1e6));
}

/// Images of one scene.
double image_bytes(const Request& request) {
  double bytes = 0.0;
  for (const Sensor& sensor : request.sensors) {
    bytes += per_pixel * sensor.width * static_cast<double>(sensor.height);
    if (sensor.model == "image" && sensor.settings.of<ImageSettings>().denoise)
      bytes += per_denoised_pixel * sensor.width * static_cast<double>(sensor.height);
    if (sensor_model(sensor.model).image != SensorModel::Image::profiles) continue;
    bytes += per_pixel * std::max(sensor.width, sensor.height) * static_cast<double>(sensor.scan.profiles);
  }
  return bytes;
}

}  // namespace

std::size_t scenes_seen_at_once(const Request& request, double estimate) {
  const double one = std::max(1.0, image_bytes(request));
  BIN_SCENES_ASSERT(std::isfinite(one) && std::isfinite(estimate));
  return 1 + static_cast<std::size_t>(std::clamp((request.memory_budget - estimate) / one, 0.0, 1e6));
}

double estimate_memory(const LoadedRequest& loaded) {
  const Request& request = loaded.request;
  const std::vector<PartModelPtr>& parts = loaded.parts;
  double bodies = 0.0;
  for (std::size_t line = 0; line < request.parts.size(); ++line) {
    const PartModel* part = line < parts.size() ? parts[line].get() : nullptr;
    bodies += body_bytes(request, part) * static_cast<double>(request.parts[line].count);
  }
  // The CPU pours as many scenes at once as it has threads, and some that are finished wait for a judge.
  const double scenes = static_cast<double>(request.scenes), count = static_cast<double>(request.part_count());
  const double at_once = request.solver.type == SolverType::bullet ? 1.0 : tbb::this_task_arena::max_concurrency();
  bodies *= std::min(scenes, at_once);
  bodies += per_waiting_part * std::min(scenes * count, most_parts_waiting + count);
  const double overlaps = overlap_bytes(loaded, 1.1 * request.memory_budget) * std::min(scenes, at_once);
  const double pixels = image_bytes(request);
  double models = 0.0;
  const std::size_t nodes = field_nodes_that_fit({request, parts});
  for (const PartModelPtr& part : std::set<PartModelPtr>(parts.begin(), parts.end()))
    models += model_bytes(request, *part, nodes);
  const bool thesis =
      request.solver.type != SolverType::bullet && request.solver.preset == SolverSettings::Preset::thesis;
  const double grid = thesis ? 8.0 * std::pow(request.solver.thesis.grid_size, 3) : 0.0;
  const double program = program_bytes + (thesis ? device_bytes : 0.0);
  const double apart = program + bodies + pixels + models + grid, total = apart + overlaps;
  BIN_SCENES_ASSERT(std::isfinite(total) && total >= program && overlaps >= 0.0);
  if (total > request.memory_budget) {
    const bool within_each_other = apart <= request.memory_budget;
    throw input_error(
        "the request needs about " + in_megabytes(total) + (within_each_other ? " or more" : "") + " (parts " +
            in_megabytes(bodies) + ", models " + in_megabytes(models) + ", grid " + in_megabytes(grid) + ", images " +
            in_megabytes(pixels) + ", program and device " + in_megabytes(program) +
            (overlaps > 0.0 ? ", parts that start within each other " + in_megabytes(overlaps) : "") +
            "), the budget is " + in_megabytes(request.memory_budget),
        "memory_budget",
        within_each_other ? "move the start poses apart" : "ask for fewer parts or pixels, or raise memory_budget");
  }
  return total;
}

}  // namespace bin_scenes
