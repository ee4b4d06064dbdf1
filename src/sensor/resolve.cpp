/// Places cameras by the bin's rim or mesh and turns projector or laser to its centre. Refuses what stands in a wall,
/// below the floor or in a part, or looks away.
#include "bin_scenes/sensor/resolve.hpp"

#include "bin_scenes/core/assertion.hpp"

#include "bin_scenes/core/error.hpp"
#include "bin_scenes/sensor/image_settings.hpp"
#include "bin_scenes/sensor/sensor_model.hpp"
#include "bin_scenes/sensor/stereo_pipeline.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes {

namespace {

/// What a camera above the bin has to see: the rim and its height, or the floor.
struct Rim {
  Vec3 center, half;
};

Rim rim_of(const Bin& bin, const Aabb* bounds) {
  Rim rim{Vec3(0.0, 0.0, bin.kind == Bin::Kind::box ? bin.inner_size.z() : 0.0), 0.5 * bin.inner_size};
  if (bin.kind == Bin::Kind::box) rim.half.head<2>().array() += bin.wall_thickness;
  if (bin.kind == Bin::Kind::mesh && bounds && !bounds->empty()) {
    rim.center = {bounds->center().x(), bounds->center().y(), bounds->upper.z()};
    rim.half = 0.5 * bounds->size();
  }
  return rim;
}

Vec3 center_of(const Bin& bin, const Aabb* bounds) {
  if (bin.kind == Bin::Kind::mesh && bounds && !bounds->empty()) return bounds->center();
  return {0.0, 0.0, bin.kind == Bin::Kind::box ? 0.5 * bin.inner_size.z() : 0.0};
}

/// A baseline away along the camera's x, its z towards `target`, its x as near to the camera's as that leaves it.
Pose beside(const Pose& camera, double baseline, const Vec3& target) {
  const Vec3 right = camera.orientation * Vec3::UnitX();
  Pose pose;
  pose.position = camera.position + baseline * right;
  BIN_SCENES_ASSERT(is_rigid(camera) && target != pose.position);
  Mat3 axes;
  axes.col(2) = (target - pose.position).normalized();
  axes.col(0) = (right - axes.col(2) * axes.col(2).dot(right)).normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  pose.orientation = Quat(axes).normalized();
  return pose;
}

[[noreturn]] void refuse(const std::string& what, const std::string& where, const std::string& remedy) {
  throw input_error(what, where, remedy);
}

bool crosses(const Aabb& box, const Vec3& origin, const Vec3& direction, double far) {
  double first = 0.0, last = far;
  for (int k = 0; k < 3; ++k) {
    if (direction[k] == 0.0) {
      if (origin[k] < box.lower[k] || origin[k] > box.upper[k]) return false;
      continue;
    }
    const double a = (box.lower[k] - origin[k]) / direction[k], b = (box.upper[k] - origin[k]) / direction[k];
    first = std::max(first, std::min(a, b));
    last = std::min(last, std::max(a, b));
  }
  return first <= last;
}

/// The space where parts can lie; empty where that is unknown. A floor has no walls and bears as much as is poured.
Aabb room_of(const Bin& bin, const Aabb* bounds) {
  Aabb room;
  const double wide = 1e4;
  if (bin.kind == Bin::Kind::box) {
    room.extend({-0.5 * bin.inner_size.x(), -0.5 * bin.inner_size.y(), 0.0});
    room.extend({0.5 * bin.inner_size.x(), 0.5 * bin.inner_size.y(), bin.inner_size.z()});
  } else if (bin.kind == Bin::Kind::floor) {
    room.extend(Vec3(-wide, -wide, 0.0));
    room.extend(Vec3(wide, wide, bin.inner_size.z()));
  } else if (bin.kind == Bin::Kind::mesh && bounds) {
    room = *bounds;
  }
  return room;
}

/// Depth that images have to count up to: of the room's far corners, of the floor in view, or all there is in range.
double deepest(const Sensor& sensor, const Bin& bin, const Aabb& room) {
  const Pose bin_in_camera = sensor.pose->inverse();
  double depth = 0.0;
  if (bin.kind == Bin::Kind::floor) {
    const Lens lens = lens_of(sensor);
    for (const double column : {0.0, lens.width - 1.0}) {
      for (const double row : {0.0, lens.height - 1.0}) {
        const double fall = -(sensor.pose->orientation * lens.ray(column, row)).z();
        depth = std::max(depth, fall > 0.0 ? sensor.pose->position.z() / fall : sensor.far);
      }
    }
  } else {
    for (int corner = 0; corner < 8 && !room.empty(); ++corner) {
      const Vec3 at(corner & 1 ? room.upper.x() : room.lower.x(), corner & 2 ? room.upper.y() : room.lower.y(),
                    corner & 4 ? room.upper.z() : room.lower.z());
      depth = std::max(depth, (bin_in_camera * at).z());
    }
  }
  return depth > 0.0 ? std::min(1.02 * depth, sensor.far) : sensor.far;
}

/// Finest of 1, 2, 5, 10, ... um with which 65,534 counts reach that depth; of a sensor whose depth has a unit a
/// fraction of it, so that its multiples are stored exactly.
double scale_for(double depth, double unit) {
  constexpr double most = 65534.0;
  double scale = 0.0;
  for (double per_metre = 1e6; scale == 0.0; per_metre /= 10.0) {
    for (const double step : {5.0, 2.0, 1.0})
      if (step / per_metre * most >= depth) scale = step / per_metre;
  }
  if (!(unit > 0.0)) return scale;
  const double fraction = unit / std::ceil(unit / scale * (1.0 - 1e-9));
  return fraction * most >= depth ? fraction : scale;
}

/// In the material of a box's walls, which rise from the floor to the rim.
bool in_wall(const Bin& bin, const Vec3& position) {
  if (bin.kind != Bin::Kind::box || position.z() < 0.0 || position.z() > bin.inner_size.z()) return false;
  const Eigen::Array2d out = position.head<2>().array().abs() - 0.5 * bin.inner_size.head<2>().array();
  return out.maxCoeff() > 0.0 && out.maxCoeff() < bin.wall_thickness;
}

/// Whether the sheet meets the room in some profile.
bool sheet_meets(const Aabb& room, const Sensor& sensor) {
  constexpr int rays = 32, places = 16;
  const double half = std::tan(0.5 * sensor.settings.of<LaserLineSettings>().fan),
               travel = sensor.scan.step * (sensor.scan.profiles - 1);
  for (int k = 0; k <= places; ++k) {
    const Vec3 start = sensor.laser.pose->position +
                       travel * (static_cast<double>(k) / places - 0.5) * sensor.scan.direction.normalized();
    for (int i = 0; i <= rays; ++i) {
      const Vec3 ray(0.0, half * (2.0 * i / rays - 1.0), 1.0);
      if (crosses(room, start, sensor.laser.pose->orientation * ray, 2.0 * sensor.far)) return true;
    }
  }
  return false;
}

bool looks_at(const Aabb& room, const Lens& lens, const Pose& pose, double far) {
  constexpr int steps = 16;
  for (int y = 0; y <= steps; ++y) {
    for (int x = 0; x <= steps; ++x) {
      const Vec3 ray = lens.ray((lens.width - 1.0) * x / steps, (lens.height - 1.0) * y / steps);
      if (ray.allFinite() && crosses(room, pose.position, pose.orientation * ray, far)) return true;
    }
  }
  // A bin smaller than the steps between rays.
  const auto pixel = lens.project(pose.inverse() * room.center());
  return pixel && lens.inside(*pixel);
}

/// Camera, projector and laser in turn.
void check_place(const std::string& what, const std::string& where, const Vec3& position, const Aabb& room,
                 const LoadedRequest& loaded) {
  if (!room.empty() && position.z() <= room.lower.z()) {
    refuse("the " + what + " stands " + std::to_string(room.lower.z() - position.z()) + " m below the floor", where,
           "give it a pose with positive z");
  }
  if (in_wall(loaded.request.bin, position)) {
    refuse("the " + what + " stands inside the bin's wall", where, "move it out of the wall, or above the rim");
  }
  for (std::size_t line = 0; line < loaded.parts.size(); ++line) {
    for (std::size_t i = 0; i < loaded.request.parts[line].poses.size(); ++i) {
      const Vec3 here = loaded.request.parts[line].poses[i].inverse() * position;
      if (here.norm() > 1e3 || !loaded.parts[line]->query().inside(here)) continue;
      refuse("the " + what + " stands inside part " + std::to_string(i) + " of parts[" + std::to_string(line) + "]",
             where, "move it out of the part");
    }
  }
}

void check_lens(const std::string& what, const std::string& where, const Lens& lens) {
  for (const double column : {0.0, 0.5 * (lens.width - 1), lens.width - 1.0}) {
    for (const double row : {0.0, 0.5 * (lens.height - 1), lens.height - 1.0}) {
      if (lens.ray(column, row).allFinite()) continue;
      refuse("the distortion of the " + what + " folds the image back before its corners", where,
             "check the coefficients' signs and order, k1 k2 p1 p2 k3, or narrow the field of view");
    }
  }
}

void check_sensor(const Sensor& sensor, const LoadedRequest& loaded, const Aabb* bounds) {
  const std::string where = "sensors: " + sensor.name;
  const Aabb room = room_of(loaded.request.bin, bounds);
  const auto looks = [&](const std::string& what, const Lens& lens, const Pose& pose) {
    check_lens(what, where, lens);
    if (!room.empty() && !looks_at(room, lens, pose, sensor.far)) {
      refuse("the " + what + " looks away from the bin", where,
             "z of its frame points forward; turn it, or leave its pose out");
    }
  };
  check_place("camera", where, sensor.pose->position, room, loaded);
  looks("camera", lens_of(sensor), *sensor.pose);
  const SensorModel& model = sensor_model(sensor.model);
  for (const auto& [what, pose] : light_of(sensor)) check_place(what, where, pose.position, room, loaded);
  if (model.projector) looks("projector", lens_of(sensor.projector), *sensor.projector.pose);
  if (model.laser && !room.empty() && !sheet_meets(room, sensor)) {
    refuse("the laser looks away from the bin", where,
           "z of its frame points forward, in the center of the sheet; turn it, or leave its pose out");
  }
  if (model.check_places) model.check_places(sensor, where);
}

}  // namespace

Sensor resolved(const Sensor& sensor, const Bin& bin, const Aabb* bounds) {
  Sensor full = sensor;
  const std::string where = "sensors: " + sensor.name;
  if (!(sensor.near > 0.0 && sensor.far > sensor.near)) {
    refuse("near and far do not bound a range", where, "give 0 < near < far in metres");
  }
  if (full.k.empty()) {
    const Lens lens = Lens::from_fov(sensor.width, sensor.height, sensor.fov);
    full.k = {lens.fx, 0.0, lens.cx, 0.0, lens.fy, lens.cy, 0.0, 0.0, 1.0};
  }
  if (full.k.size() != 9 || !(full.k[0] > 0.0) || !(full.k[4] > 0.0)) {
    refuse("K is not a 3x3 matrix of intrinsics", where, "give nine numbers, row by row, with fx, fy > 0");
  }
  if (!full.pose) {
    const auto [center, half] = rim_of(bin, bounds);
    const double columns = std::min(full.k[2], sensor.width - 1 - full.k[2]);
    const double rows = std::min(full.k[5], sensor.height - 1 - full.k[5]);
    if (!(columns > 0.0 && rows > 0.0)) {
      refuse("the principal point lies outside the image", where, "give the sensor a pose of its own");
    }
    const double height =
        1.05 * std::max((full.k[0] * half.x() + std::abs(full.k[1]) * half.y()) / columns, full.k[4] * half.y() / rows);
    const Vec3 eye = center + std::max(height, 1.05 * sensor.near) * Vec3::UnitZ();
    full.pose = Pose{eye, Quat(0.0, 1.0, 0.0, 0.0)};  // half a turn about x: z down, y to the rear
  }
  Vec3 target = center_of(bin, bounds);
  const double ahead = (full.pose->inverse() * target).z();
  if (bin.kind == Bin::Kind::none || !(ahead > sensor.near)) {  // no bin to aim at: a point on the optical axis
    target = *full.pose * Vec3(0.0, 0.0, std::sqrt(sensor.near * sensor.far));
  }
  if (!full.projector.pose) full.projector.pose = beside(*full.pose, full.projector.baseline, target);
  if (!full.laser.pose) full.laser.pose = beside(*full.pose, full.laser.baseline, target);
  for (ImageLamp& lamp : full.settings.of<ImageSettings>().lamps)
    if (!lamp.pose) lamp.pose = full.pose;
  const SensorModel& model = sensor_model(sensor.model);
  if (!full.bounces && model.indirect) full.bounces = model.bounces;
  full.depth_scale =
      scale_for(deepest(full, bin, room_of(bin, bounds)), full.noise ? full.settings.of<DepthFormat>().unit : 0.0);
  BIN_SCENES_ASSERT(is_rigid(*full.pose) && is_rigid(*full.projector.pose) && is_rigid(*full.laser.pose));
  BIN_SCENES_ASSERT(full.k.size() == 9 && full.depth_scale > 0.0);
  return full;
}

std::vector<Sensor> resolved_sensors(const LoadedRequest& loaded) {
  const Request& request = loaded.request;
  const PartModelPtr& bin_model = loaded.bin_model;
  Aabb bounds;
  if (bin_model) {
    for (const Vec3& v : bin_model->mesh().vertices) bounds.extend(request.bin.pose * v);
  }
  check_sensors(request.sensors);
  std::vector<Sensor> sensors;
  for (const Sensor& sensor : request.sensors) {
    sensors.push_back(resolved(sensor, request.bin, bin_model ? &bounds : nullptr));
    check_sensor(sensors.back(), loaded, bin_model ? &bounds : nullptr);
  }
  return sensors;
}

}  // namespace bin_scenes
