#include "sensor/models/predicted_sigma.hpp"

#include "bin_scenes/sensor/resolve.hpp"
#include "sensor/models/from_sensor.hpp"
#include "sensor/models/time_of_flight_noise.hpp"
#include "sensor/targets.hpp"

#include <cmath>
#include <limits>

namespace bin_scenes {

namespace {

/// The middle of the image alone: as many rays as a pixel's surroundings take.
Sensor middle_of(const Sensor& sensor) {
  Sensor cut = sensor;
  const int left = (sensor.width - 9) / 2, top = (sensor.height - 9) / 2;
  cut.width = cut.height = 9;
  cut.k[2] -= left;
  cut.k[5] -= top;
  return cut;
}

}  // namespace

double predicted_sigma(const Sensor& given, double distance, double incidence, double albedo) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  if (given.model == SensorModel::ideal || !given.noise) return 0.0;
  if (given.model == SensorModel::time_of_flight) {
    const bool dark = albedo * std::cos(incidence) / (distance * distance) < given.time_of_flight.min_signal;
    return dark ? nan : axial_sigma(given.time_of_flight, distance, incidence, albedo);
  }
  const Sensor sensor = given.model == SensorModel::laser_line ? given : middle_of(given);
  Targets targets;
  const Quat turn = given.pose->orientation * Quat(Eigen::AngleAxisd(incidence, Vec3::UnitX()));
  const double size = 20.0 * distance;
  targets.add(box_target({size, size, 0.01 * size}),
              {*given.pose * Vec3(0, 0, distance) + turn * Vec3(0, 0, 0.005 * size), turn}, {albedo, 0.0, 0.4});
  const Scenery scenery = targets.scenery();
  if (sensor.model == SensorModel::laser_line) {
    return LaserLine(scenery, targets.surfaces(), laser_line_setup(sensor)).depth_sigma();
  }
  const View view = look(scenery, lens_of(sensor), *sensor.pose, sensor.near, sensor.far);
  const std::size_t pixel = view.depth.size() / 2;
  if (sensor.model == SensorModel::stereo) {
    return Stereo(scenery, view, targets.surfaces(), stereo_setup(sensor)).depth_sigma(pixel);
  }
  return StructuredLight(scenery, view, targets.surfaces(), structured_light_setup(sensor)).depth_sigma(pixel);
}

}  // namespace bin_scenes
