#include "page/symmetry_picture.hpp"

#include "bin_scenes/sensor/resolve.hpp"
#include "bin_scenes/sensor/sensor_rig.hpp"
#include "output/png.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace bin_scenes {

namespace {

using Colour = std::array<std::uint8_t, 3>;
constexpr Colour red = {214, 39, 40}, blue = {31, 119, 180};

Pose looking_at(const Vec3& from, const Vec3& target) {
  Mat3 axes;
  axes.col(2) = (target - from).normalized();
  axes.col(0) = axes.col(2).cross(Vec3::UnitZ()).normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return {from, Quat(axes).normalized()};
}

/// Axes of the discrete turns, each once.
std::vector<Vec3> axes_of(const std::vector<Pose>& turns) {
  std::vector<Vec3> axes;
  for (const Pose& turn : turns) {
    const Vec3 axis = turn.orientation.vec().normalized();
    const auto same = [&](const Vec3& other) { return std::abs(other.dot(axis)) > 0.999; };
    if (std::none_of(axes.begin(), axes.end(), same)) axes.push_back(axis);
  }
  return axes;
}

class Drawing {
 public:
  Drawing(const RangeImage& image, const Pose& camera)
      : lens_(lens_of(image.sensor)), camera_(camera), rgb_(shaded_picture(image)) {}

  /// Two pixels wide; over the part, so that axes inside it are seen.
  void line(const Vec3& from, const Vec3& to, const Colour& colour) {
    constexpr int steps = 2000;
    for (int i = 0; i <= steps; ++i) {
      const auto pixel = lens_.project(camera_.inverse() * (from + (to - from) * i / steps));
      if (!pixel) continue;
      const auto x = static_cast<int>(pixel->x()), y = static_cast<int>(pixel->y());
      for (const auto& [dx, dy] : {std::pair(0, 0), std::pair(1, 0), std::pair(0, 1), std::pair(1, 1)}) {
        if (x + dx < 0 || y + dy < 0 || x + dx >= lens_.width || y + dy >= lens_.height) continue;
        std::copy(colour.begin(), colour.end(),
                  rgb_.begin() + 3 * (static_cast<std::ptrdiff_t>(y + dy) * lens_.width + x + dx));
      }
    }
  }
  void write(const std::string& path) const { write_bytes(path, png8(lens_.width, lens_.height, 3, rgb_)); }

 private:
  Lens lens_;
  Pose camera_;
  std::vector<std::uint8_t> rgb_;
};

}  // namespace

void write_symmetry_picture(const std::string& path, const PartModelPtr& part, const Symmetries& symmetries) {
  const Vec3 center = part->mass().center;
  const double size = part->diagonal();
  Request request;
  request.bin.kind = Bin::Kind::none;
  request.parts.resize(1);
  Scene scene;
  scene.parts.resize(1);
  scene.parts[0].state = PartState::fixed;
  Sensor sensor;
  sensor.width = 640, sensor.height = 480;
  sensor.pose = looking_at(center + 2.6 * size * Vec3(0.55, -0.65, 0.53), center);
  sensor.near = 0.1 * size, sensor.far = 10.0 * size;
  scene.sensors = {resolved(sensor, request.bin, nullptr)};
  SensorRig rig;
  Drawing picture(rig.render(scene, {request, {part}}).at(0), *sensor.pose);
  const auto draw = [&](const Vec3& axis, const Colour& colour) {
    picture.line(center - 0.75 * size * axis, center + 0.75 * size * axis, colour);
  };
  for (const Vec3& axis : axes_of(symmetries.discrete)) draw(axis, blue);
  for (const Symmetries::Axis& axis : symmetries.continuous) draw(axis.direction, red);
  picture.write(path);
}

}  // namespace bin_scenes
