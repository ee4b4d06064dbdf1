#include "bin_scenes/sensor/calibration.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/core/random.hpp"
#include "bin_scenes/sensor/resolve.hpp"
#include "bin_scenes/sensor/sensor_model.hpp"
#include "bin_scenes/sensor/stereo_pipeline.hpp"
#include "sensor/report_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bin_scenes {

namespace {

/// A device is the same in all scenes.
constexpr std::uint64_t no_scene = std::numeric_limits<std::uint64_t>::max();

/// The first view of the same device.
std::size_t device_of(const std::vector<Sensor>& sensors, std::size_t number) {
  if (sensors[number].view_of.empty()) return number;
  std::size_t first = 0;
  while (sensors[first].view_of != sensors[number].view_of) ++first;
  return first;
}

void err_in_lens_and_baseline(const CalibrationSettings& sigma, Random draw, Sensor& device) {
  const double focal = 1.0 + sigma.focal * draw.normal() / device.k[0];
  device.k[0] *= focal;
  device.k[4] *= focal;
  device.k[2] += sigma.center * draw.normal();
  device.k[5] += sigma.center * draw.normal();
  const double longer = sigma.baseline * draw.normal();
  const auto move = [&](std::optional<Pose>& light) {
    const Vec3 offset = light->position - device.pose->position;
    if (offset.norm() > 0.0) light->position += longer * offset.normalized();
  };
  move(device.projector.pose);
  move(device.laser.pose);
  device.settings.of<StereoSettings>().baseline += longer;
  device.settings.of<CalibrationSettings>().range = sigma.range * draw.normal();
}

void err_in_pose(const CalibrationSettings& sigma, Random draw, Sensor& device) {
  const auto normals = [&] {
    const double x = draw.normal(), y = draw.normal();
    return Vec3(x, y, draw.normal());
  };
  const Vec3 shift = sigma.position * normals(), turn = sigma.rotation * normals();
  const Quat turned = turn.norm() > 0.0 ? Quat(Eigen::AngleAxisd(turn.norm(), turn.normalized())) : Quat::Identity();
  const Pose moved = *device.pose * Pose{shift, turned} * device.pose->inverse();
  for (std::optional<Pose>* pose : {&device.pose, &device.projector.pose, &device.laser.pose}) *pose = moved * **pose;
  BIN_SCENES_ASSERT(is_rigid(moved) && is_rigid(*device.pose));
}

/// Without triangulation the range along the ray stays, but for its offset.
void keep_ranges(RangeImage& image, const Sensor& device, const Sensor& believed) {
  const Lens eye = lens_of(device), read = lens_of(believed);
  const double offset = device.settings.of<CalibrationSettings>().range;
  const auto depth_of = [&](double column, double row, double depth) {
    const double range = depth * eye.ray(column, row).norm() + offset;
    return range > 0.0 ? range / read.ray(column, row).norm() : std::numeric_limits<double>::quiet_NaN();
  };
  report_depths(image, depth_of, Validity::nothing);
}

/// At least one unit: 0 means that nothing was measured. Points that are not on the rays of their pixels keep x and y.
void round_depths(RangeImage& image, double unit) {
  if (!(unit > 0.0)) return;
  report_depths(image, [unit](double, double, double depth) { return std::max(std::round(depth / unit), 1.0) * unit; });
  for (std::size_t i = 0; i < image.points.size(); ++i)
    if (!std::isnan(image.depth[i])) image.points[i][2] = image.depth[i];
}

}  // namespace

Sensor true_device(const std::vector<Sensor>& sensors, std::size_t number, std::uint64_t seed) {
  BIN_SCENES_ASSERT(number < sensors.size() && sensors[number].pose && sensors[number].k.size() == 9);  // resolved()
  Sensor device = sensors.at(number);
  const auto sigma = device.settings.of<CalibrationSettings>();
  if (!sigma.any()) return device;
  const Random draw(seed, no_scene, Stream::sensor);
  err_in_lens_and_baseline(sigma, draw.of_piece(2 * device_of(sensors, number)), device);
  err_in_pose(sigma, draw.of_piece(2 * number + 1), device);
  return device;
}

void report_as_believed(RangeImage& image, const Sensor& device, const Sensor& believed) {
  image.sensor = believed;
  const SensorModel& model = sensor_model(believed.model);
  if (believed.settings.of<CalibrationSettings>().any()) {
    image.device = device;
    (model.report ? model.report : keep_ranges)(image, device, believed);
  }
  if (believed.noise && !model.exact) round_depths(image, believed.settings.of<DepthFormat>().unit);
}

}  // namespace bin_scenes
