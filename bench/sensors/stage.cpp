#include "sensors/stage.hpp"

#include "bin_scenes/sensor/resolve.hpp"
#include "sensor/models/of_sensor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bin_scenes::bench {

Sensor sensor_of(const std::string& model, double distance) {
  Sensor sensor;
  sensor.model = model;
  sensor.width = 640;
  sensor.height = 512;
  sensor.fov = 0.4;
  sensor.near = distance / 2;  // without a bin, light is aimed at sqrt(near far)
  sensor.far = distance * 2;
  sensor.pose = Pose();
  sensor.bounces = 0;  // the figures are of geometry and noise; light.cpp has those of indirect light
  Bin nothing;
  nothing.kind = Bin::Kind::none;
  return resolved(sensor, nothing);
}

Targets plate(double z, double degrees, double albedo) {
  Targets targets;
  const Quat turn(Eigen::AngleAxisd(degrees * M_PI / 180.0, Vec3::UnitX()));
  targets.add(box_target({20.0, 20.0, 0.02}), {Vec3(0, 0, z) + turn * Vec3(0, 0, 0.01), turn}, {albedo, 0.0, 0.4});
  return targets;
}

Targets still_life() {
  Targets targets = plate(1.0, 0.0, 0.5);
  targets.add(ball_target(0.05, 5), {Vec3(-0.06, 0.0, 0.95), Quat::Identity()}, {0.8, 0.1, 0.4});
  targets.add(box_target({0.05, 0.08, 0.06}),
              {Vec3(0.07, 0.02, 0.95), Quat(Eigen::AngleAxisd(0.5, Vec3(1, 1, 1).normalized()))}, {0.1, 0.0, 0.4});
  return targets;
}

namespace {

template <class Model>
void measure_by(const Model& model, const Sensor& sensor, const Random& random, Shot& shot) {
  shot.measured = sensor.fidelity == Fidelity::decoded ? model.decoded(random) : model.analytic(random);
  for (std::size_t i = 0; i < shot.view.depth.size(); ++i) shot.sigma.push_back(model.depth_sigma(i));
}

}  // namespace

Shot shoot(Targets& targets, const Sensor& sensor, std::uint64_t seed) {
  const Scenery scenery = targets.scenery();
  Shot shot;
  shot.view = render(scenery, lens_of(sensor), *sensor.pose, sensor.near, sensor.far);
  const Random random(seed, 0, Stream::noise);
  if (sensor.model == "stereo") {
    measure_by(Stereo(scenery, shot.view, targets.surfaces(), stereo_setup(sensor)), sensor, random, shot);
  } else {
    measure_by(StructuredLight(scenery, shot.view, targets.surfaces(), structured_light_setup(sensor)), sensor, random,
               shot);
  }
  return shot;
}

std::vector<double> sorted_errors(const Shot& shot) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < shot.view.depth.size(); ++i) {
    if (shot.measured.validity[i] != Validity::valid) continue;
    errors.push_back(std::abs(shot.measured.depth[i] - shot.view.depth[i]));
  }
  std::sort(errors.begin(), errors.end());
  return errors;
}

double quantile(const std::vector<double>& sorted, double share) {
  if (sorted.empty()) return std::numeric_limits<double>::quiet_NaN();
  return sorted[std::min(sorted.size() - 1, static_cast<std::size_t>(share * static_cast<double>(sorted.size())))];
}

}  // namespace bin_scenes::bench
