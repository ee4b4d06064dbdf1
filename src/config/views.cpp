#include "config/views.hpp"

#include "bin_scenes/core/error.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes::config {

namespace {

constexpr std::size_t most_views = 1000;

/// Equal parts of the dome's surface, along a spiral by the golden angle.
std::vector<Pose> dome(const Views& views) {
  const double golden_angle = M_PI * (3.0 - std::sqrt(5.0));
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < views.count; ++i) {
    const double share = (static_cast<double>(i) + 0.5) / static_cast<double>(views.count);
    const double tilt = std::acos(1.0 - share * (1.0 - std::cos(views.tilt)));
    poses.push_back(looking_at(views.target, views.distance, tilt, golden_angle * static_cast<double>(i), 0.0));
  }
  return poses;
}

/// Below the rim, where parts lie.
bool in_bin(const Bin& bin, const Vec3& position) {
  return bin.kind == Bin::Kind::box && position.z() > 0.0 && position.z() < bin.inner_size.z() &&
         (position.head<2>().array().abs() < 0.5 * bin.inner_size.head<2>().array()).all();
}

using Where = std::function<std::string(const std::string& path)>;
using Given = std::function<bool(const std::string& path)>;

/// Index of the sensor whose keys say where sensor i stands: itself, or the one that its `pose_of` names.
std::size_t placed_by(const Request& request, std::size_t i, const Where& where, const Given& given) {
  const Sensor& sensor = request.sensors[i];
  if (sensor.pose_of.empty()) return i;
  const std::string sensor_key = "sensors[" + std::to_string(i) + "].", key = sensor_key + "pose_of";
  const auto refuse = [&](const std::string& problem, const std::string& remedy) {
    throw input_error("'" + key + "': " + problem, where(key), remedy);
  };
  std::string known;
  std::size_t other = request.sensors.size();
  for (std::size_t k = 0; k < request.sensors.size(); ++k) {
    if (k == i || !request.sensors[k].pose_of.empty()) continue;
    known += (known.empty() ? "" : ", ") + request.sensors[k].name;
    if (request.sensors[k].name == sensor.pose_of) other = k;
  }
  if (other == request.sensors.size())
    refuse("'" + sensor.pose_of + "' is no other sensor with a place of its own",
           known.empty() ? "remove this key, and give a pose" : "one of " + known);
  for (const char* own : {"width", "height", "fov", "k", "distortion", "pose", "views", "projector", "near", "far"})
    if (given(sensor_key + own)) refuse(std::string("the sensor has ") + own + " of its own", "remove one of both");
  return other;
}

void place_as(const Sensor& other, Sensor& sensor) {
  sensor.width = other.width, sensor.height = other.height;
  sensor.fov = other.fov, sensor.k = other.k, sensor.distortion = other.distortion;
  sensor.pose = other.pose, sensor.views = other.views;
  sensor.projector = other.projector;
  sensor.near = other.near, sensor.far = other.far;
  sensor.pose_of.clear();
}

}  // namespace

Pose looking_at(const Vec3& target, double distance, double tilt, double turn, double roll) {
  const auto about = [](double angle, const Vec3& axis) { return Quat(Eigen::AngleAxisd(angle, axis)); };
  const Quat lean = about(turn, Vec3::UnitZ()) * about(tilt, Vec3::UnitY()) * about(-turn, Vec3::UnitZ());
  Pose pose;
  pose.orientation = (lean * about(M_PI, Vec3::UnitX()) * about(roll, Vec3::UnitZ())).normalized();
  pose.position = target + lean * Vec3(0.0, 0.0, distance);
  return pose;
}

void spell_out_views(Request& request, const Where& where, const Given& given) {
  std::vector<Sensor> sensors;
  std::vector<std::size_t> placed;
  for (std::size_t i = 0; i < request.sensors.size(); ++i) placed.push_back(placed_by(request, i, where, given));
  for (std::size_t i = 0; i < request.sensors.size(); ++i)
    if (placed[i] != i) place_as(request.sensors[placed[i]], request.sensors[i]);
  for (std::size_t i = 0; i < request.sensors.size(); ++i) {
    const Sensor& sensor = request.sensors[i];
    const std::string key = "sensors[" + std::to_string(placed[i]) + "].views";
    const auto refuse = [&](const std::string& name, const std::string& problem, const std::string& remedy) {
      throw input_error("'" + key + name + "': " + problem, where(key + name), remedy);
    };
    if (!given(key)) {
      sensors.push_back(sensor);
      continue;
    }
    const Views& views = sensor.views;
    if (sensor.pose) refuse("", "the sensor also has the key `pose`", "remove one of both");
    if (views.poses.empty() == (views.count == 0))
      refuse("", "needs either poses or count", "for instance views: {count: 8, distance: 0.8, tilt: 0.5}");
    if (std::max(views.count, views.poses.size()) > most_views)
      refuse("", "are more than " + std::to_string(most_views), "ask for fewer");
    if (views.poses.empty() && !(views.distance > 0.0 && std::isfinite(views.distance)))
      refuse(".distance", "must be above 0", "m from target");
    if (views.poses.empty() && !(views.tilt >= 0.0 && views.tilt < M_PI_2))
      refuse(".tilt", "must be 0 to less than pi/2", "rad from the vertical");
    const std::vector<Pose> poses = views.poses.empty() ? dome(views) : views.poses;
    for (std::size_t n = 0; n < poses.size(); ++n) {
      if (in_bin(request.bin, poses[n].position))
        refuse("", "view " + std::to_string(n) + " stands inside the bin, where the heap is", "move it above the rim");
      sensors.push_back(sensor);
      Sensor& view = sensors.back();
      view.views = Views();
      view.pose = poses[n];
      view.view_of = sensor.name;
      view.name = sensor.name + "_" + std::to_string(n);
    }
  }
  request.sensors = std::move(sensors);
}

}  // namespace bin_scenes::config
