#include "bin_scenes/core/error.hpp"
#include "bin_scenes/sensor/range_camera.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bin_scenes {

std::array<float, 3> point_at(const RangeImage& image, int column, int row) {
  const std::vector<double>& k = image.sensor.k;
  const double z = image.depth[static_cast<std::size_t>(row) * image.sensor.width + column];
  const double y = (row - k[5]) / k[4], x = (column - k[2] - k[1] * y) / k[0];
  return {static_cast<float>(x * z), static_cast<float>(y * z), static_cast<float>(z)};
}

Sensor resolved(const Sensor& sensor, const Bin& bin, const Aabb* bounds) {
  Sensor full = sensor;
  const std::string where = "sensors: " + sensor.name;
  if (!(sensor.near > 0.0 && sensor.far > sensor.near)) {
    throw input_error("near and far do not bound a range", where, "give 0 < near < far in metres");
  }
  if (full.k.empty()) {
    const double f = 0.5 * sensor.width / std::tan(0.5 * sensor.fov);
    full.k = {f, 0.0, 0.5 * (sensor.width - 1), 0.0, f, 0.5 * (sensor.height - 1), 0.0, 0.0, 1.0};
  }
  if (full.k.size() != 9 || !(full.k[0] > 0.0) || !(full.k[4] > 0.0)) {
    throw input_error("K is not a 3x3 matrix of intrinsics", where, "give nine numbers, row by row, with fx, fy > 0");
  }
  if (full.pose) return full;

  Vec3 middle(0.0, 0.0, bin.kind == Bin::Kind::box ? bin.inner_size.z() : 0.0);
  Vec3 half = 0.5 * bin.inner_size;
  if (bin.kind == Bin::Kind::box) half.head<2>().array() += bin.wall_thickness;
  if (bin.kind == Bin::Kind::mesh && bounds && !bounds->empty()) {
    middle = {bounds->center().x(), bounds->center().y(), bounds->upper.z()};
    half = 0.5 * bounds->size();
  }
  const double columns = std::min(full.k[2], sensor.width - 1 - full.k[2]);
  const double rows = std::min(full.k[5], sensor.height - 1 - full.k[5]);
  if (!(columns > 0.0 && rows > 0.0)) {
    throw input_error("the principal point lies outside the image", where, "give the sensor a pose of its own");
  }
  const double height =
      1.05 * std::max((full.k[0] * half.x() + std::abs(full.k[1]) * half.y()) / columns, full.k[4] * half.y() / rows);
  const Vec3 eye = middle + std::max(height, 1.05 * sensor.near) * Vec3::UnitZ();
  full.pose = Pose{eye, Quat(0.0, 1.0, 0.0, 0.0)};  // half a turn about x: z down, y to the rear
  return full;
}

}  // namespace bin_scenes
