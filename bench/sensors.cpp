/// Sensors against closed forms, predicted noise and each other, and what they cost: the goals of docs for range
/// sensors.
#include "framework/benchmark.hpp"
#include "runs.hpp"

#include "bin_scenes/sensor/models.hpp"
#include "bin_scenes/sensor/resolve.hpp"
#include "sensor/fit.hpp"
#include "sensor/models/from_sensor.hpp"
#include "sensor/targets.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace bin_scenes::bench {
namespace {

Sensor sensor_of(SensorModel model, double distance) {
  Sensor sensor;
  sensor.model = model;
  sensor.width = 640;
  sensor.height = 512;
  sensor.fov = 0.4;
  sensor.near = distance / 2;
  sensor.far = distance * 2;  // aims at sqrt(near far)
  sensor.pose = Pose();
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

struct Shot {
  View view;
  Measurement measured;
  std::vector<double> sigma;
};

Shot shoot(Targets& targets, const Sensor& sensor, std::uint64_t seed) {
  const Scenery scenery = targets.scenery();
  Shot shot{look(scenery, lens_of(sensor), *sensor.pose, sensor.near, sensor.far), Measurement(0), {}};
  const StructuredLight model(scenery, shot.view, targets.surfaces(), structured_light_setup(sensor));
  const Random random(seed, 0, Stream::noise);
  shot.measured = sensor.fidelity == Fidelity::decoded ? model.decoded(random) : model.analytic(random);
  for (std::size_t i = 0; i < shot.view.depth.size(); ++i) shot.sigma.push_back(model.depth_sigma(i));
  return shot;
}

void plane_errors(Run& out, double z) {
  const Row key = Row().key("what", "decoded, no noise: error on a plane").key("distance_m", z);
  if (!out.wanted(key)) return;
  Sensor sensor = sensor_of(SensorModel::structured_light, z);
  sensor.fidelity = Fidelity::decoded;
  sensor.noise = false;
  Targets targets = plate(z, 20.0, 0.5);
  const Shot shot = shoot(targets, sensor, 0);
  std::vector<double> errors;
  for (std::size_t i = 0; i < shot.sigma.size(); ++i) {
    if (shot.measured.validity[i] == Validity::valid) {
      errors.push_back(1e3 * std::abs(shot.measured.depth[i] - shot.view.depth[i]));
    }
  }
  std::sort(errors.begin(), errors.end());
  out.row(Row(key).exact("median_mm", errors[errors.size() / 2]).exact("p99_mm", errors[errors.size() * 99 / 100]));
}

void noise(Run& out, double z, double degrees, double albedo, Fidelity fidelity) {
  const Row key = Row()
                      .key("what", fidelity == Fidelity::decoded ? "decoded: measured / predicted sigma"
                                                                 : "analytic: measured / predicted sigma")
                      .key("distance_m", z)
                      .key("incidence_deg", degrees)
                      .key("albedo", albedo);
  if (!out.wanted(key)) return;
  Sensor sensor = sensor_of(SensorModel::structured_light, z);
  sensor.fidelity = fidelity;
  Targets targets = plate(z, degrees, albedo);
  const Shot shot = shoot(targets, sensor, 1);
  double square = 0.0, predicted = 0.0;
  std::size_t n = 0;
  for (std::size_t i = 0; i < shot.sigma.size(); ++i) {
    if (shot.measured.validity[i] != Validity::valid) continue;
    square += std::pow((shot.measured.depth[i] - shot.view.depth[i]) / shot.sigma[i], 2);
    predicted += shot.sigma[i];
    ++n;
  }
  const double count = static_cast<double>(n);
  out.row(Row(key)
              .exact("ratio", std::sqrt(square / count))
              .exact("sigma_mm", 1e3 * predicted / count)
              .info("samples", count));
}

void ball(Run& out, Fidelity fidelity, bool with_noise) {
  const Row key =
      Row()
          .key("what", fidelity == Fidelity::decoded ? "decoded: ball of 100 mm" : "analytic: ball of 100 mm")
          .key("noise", with_noise ? "default" : "off");
  if (!out.wanted(key)) return;
  Sensor sensor = sensor_of(SensorModel::structured_light, 1.0);
  sensor.fidelity = fidelity;
  sensor.noise = with_noise;
  Targets targets;
  targets.add(ball_target(0.1), {Vec3(0, 0, 1.0), Quat::Identity()});
  const Shot shot = shoot(targets, sensor, 1);
  std::vector<Vec3> points;
  const auto width = static_cast<std::size_t>(sensor.width);
  for (std::size_t i = 0; i < shot.sigma.size(); ++i) {
    if (shot.measured.validity[i] != Validity::valid) continue;
    points.push_back(shot.measured.depth[i] *
                     shot.view.lens.ray(static_cast<double>(i % width), static_cast<double>(i / width)));
  }
  out.row(Row(key)
              .exact("radius_error_mm", 1e3 * std::abs(fit_ball(points).radius - 0.1))
              .info("samples", static_cast<double>(points.size())));
}

/// 256 balls of 5,120 triangles in the image.
void cost(Run& out, const char* what, SensorModel model, Fidelity fidelity) {
  const Row key = Row().key("what", what);
  if (!out.wanted(key)) return;
  Sensor sensor = sensor_of(model, 1.0);
  sensor.fidelity = fidelity;
  sensor.width = 1280;
  sensor.height = 1024;
  if (model == SensorModel::stereo) {
    sensor.width = 848;
    sensor.height = 480;
  }
  sensor.k.clear();
  sensor.pose.reset();
  sensor.pose = Pose();
  Bin nothing;
  nothing.kind = Bin::Kind::none;
  sensor = resolved(sensor, nothing);
  Targets targets = plate(1.05, 0.0, 0.5);
  const Mesh mesh = ball_target(0.013, 4);
  Random random(1, 0, Stream::probe);
  for (int i = 0; i < 256; ++i) {
    const Vec3 place(0.025 * (i % 16 - 7.5), 0.02 * (i / 16 - 7.5), random.uniform(0.95, 1.03));
    targets.add(mesh, {place, random.orientation()}, {0.5, 0.1, 0.4});
  }
  std::vector<double> wall, cpu;
  const Scenery scenery = targets.scenery();
  for (int k = 0; k < (out.quick() ? 1 : 3); ++k) {
    const auto begin = std::chrono::steady_clock::now();
    const double cpu_begin = cpu_seconds();
    measure(scenery, look(scenery, lens_of(sensor), *sensor.pose, sensor.near, sensor.far), sensor, targets.surfaces(),
            {1, static_cast<std::size_t>(k), 0});
    cpu.push_back(cpu_seconds() - cpu_begin);
    wall.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  out.row(Row(key).measure("wall_s", wall).measure("cpu_s", cpu));
}

void run(Run& out) {
  for (const double z : {0.5, 1.0, 2.0}) plane_errors(out, z);
  for (const Fidelity fidelity : {Fidelity::analytic, Fidelity::decoded}) {
    for (const double z : {0.5, 1.0, 2.0}) {
      for (const double degrees : {0.0, 40.0, 70.0}) {
        for (const double albedo : {0.05, 0.5, 0.9}) {
          if (out.quick() && (degrees == 40.0 || albedo == 0.5 || z != 1.0)) continue;
          noise(out, z, degrees, albedo, fidelity);
        }
      }
    }
    for (const bool with_noise : {false, true}) ball(out, fidelity, with_noise);
  }
  cost(out, "time: ideal 1280 x 1024", SensorModel::ideal, Fidelity::analytic);
  cost(out, "time: structured light analytic", SensorModel::structured_light, Fidelity::analytic);
  cost(out, "time: structured light decoded", SensorModel::structured_light, Fidelity::decoded);
  cost(out, "time: time of flight", SensorModel::time_of_flight, Fidelity::analytic);
  cost(out, "time: laser line, 1000 profiles", SensorModel::laser_line, Fidelity::analytic);
  cost(out, "time: stereo 848 x 480 x 128 matched", SensorModel::stereo, Fidelity::decoded);
  cost(out, "time: stereo analytic", SensorModel::stereo, Fidelity::analytic);
}

const Registration registration{"sensors",
                                "range sensors: error without noise, noise over its formula, balls, time a view",
                                {"what", "distance_m", "incidence_deg", "albedo", "noise"},
                                run};

}  // namespace
}  // namespace bin_scenes::bench
