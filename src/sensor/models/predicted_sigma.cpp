#include "sensor/models/predicted_sigma.hpp"

#include "bin_scenes/sensor/resolve.hpp"
#include "sensor/models/from_sensor.hpp"
#include "sensor/models/time_of_flight_noise.hpp"
#include "sensor/targets.hpp"

#include <cmath>
#include <limits>
#include <string>

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

/// A plate at that distance, large enough for any view, tilted about the camera's x axis.
Targets plate(const Pose& camera, double distance, double incidence, double albedo) {
  Targets targets;
  const Quat turn = camera.orientation * Quat(Eigen::AngleAxisd(incidence, Vec3::UnitX()));
  const double size = 20.0 * distance;
  targets.add(box_target({size, size, 0.01 * size}),
              {camera * Vec3(0, 0, distance) + turn * Vec3(0, 0, 0.005 * size), turn}, {albedo, 0.0, 0.4});
  return targets;
}

double sigma_of_time_of_flight(const Sensor& sensor, double distance, double incidence, double albedo) {
  const bool dark = albedo * std::cos(incidence) / (distance * distance) < sensor.time_of_flight.min_signal;
  return dark ? std::numeric_limits<double>::quiet_NaN()
              : axial_sigma(sensor.time_of_flight, distance, incidence, albedo);
}

double sigma_of_laser_line(const Sensor& sensor, Targets targets) {
  const Scenery scenery = targets.scenery();
  return LaserLine(scenery, targets.surfaces(), laser_line_setup(sensor)).depth_sigma();
}

double sigma_of_stereo(const Sensor& sensor, Targets targets) {
  const Scenery scenery = targets.scenery();
  const View view = look(scenery, lens_of(sensor), *sensor.pose, sensor.near, sensor.far);
  return Stereo(scenery, view, targets.surfaces(), stereo_setup(sensor)).depth_sigma(view.depth.size() / 2);
}

double sigma_of_structured_light(const Sensor& sensor, Targets targets) {
  const Scenery scenery = targets.scenery();
  const View view = look(scenery, lens_of(sensor), *sensor.pose, sensor.near, sensor.far);
  return StructuredLight(scenery, view, targets.surfaces(), structured_light_setup(sensor))
      .depth_sigma(view.depth.size() / 2);
}

}  // namespace

double predicted_sigma(const Sensor& sensor, double distance, double incidence, double albedo) {
  if (!sensor.noise) return 0.0;
  const auto seen = [&] { return plate(*sensor.pose, distance, incidence, albedo); };
  switch (sensor.model) {
    case SensorModel::ideal:
      return 0.0;
    case SensorModel::structured_light:
      return sigma_of_structured_light(middle_of(sensor), seen());
    case SensorModel::laser_line:
      return sigma_of_laser_line(sensor, seen());
    case SensorModel::stereo:
      return sigma_of_stereo(middle_of(sensor), seen());
    case SensorModel::time_of_flight:
      return sigma_of_time_of_flight(sensor, distance, incidence, albedo);
  }
  no_sensor_model("number " + std::to_string(static_cast<int>(sensor.model)));
}

}  // namespace bin_scenes
