#include "bin_scenes/scene/request.hpp"

#include "bin_scenes/core/error.hpp"
#include "bin_scenes/scene/sensor_name.hpp"
#include "scene/sensor_check.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <set>
#include <sstream>
#include <string>

namespace bin_scenes {

double metres_per(Unit unit) {
  switch (unit) {
    case Unit::metre:
      return 1.0;
    case Unit::centimetre:
      return 1e-2;
    case Unit::millimetre:
      return 1e-3;
    case Unit::inch:
      return 0.0254;
  }
  return 1.0;
}

const char* name_of(Unit unit) {
  switch (unit) {
    case Unit::metre:
      return "m";
    case Unit::centimetre:
      return "cm";
    case Unit::millimetre:
      return "mm";
    case Unit::inch:
      return "inch";
  }
  return "?";
}

const char* name_of(SolverType type) {
  switch (type) {
    case SolverType::automatic:
      return "auto";
    case SolverType::sphere:
      return "sphere";
    case SolverType::bullet:
      return "bullet";
  }
  return "?";
}

const char* name_of(SensorModel model) {
  switch (model) {
    case SensorModel::ideal:
      return "ideal";
    case SensorModel::structured_light:
      return "structured_light";
    case SensorModel::laser_line:
      return "laser_line";
    case SensorModel::stereo:
      return "stereo";
    case SensorModel::time_of_flight:
      return "time_of_flight";
  }
  no_sensor_model("number " + std::to_string(static_cast<int>(model)));
}

SensorModel sensor_model(const std::string& name) {
  for (const SensorModel model : sensor_models)
    if (name == name_of(model)) return model;
  no_sensor_model("'" + name + "'");
}

void no_sensor_model(const std::string& found) {
  std::string known;
  for (const SensorModel model : sensor_models) known += (known.empty() ? "" : ", ") + std::string(name_of(model));
  throw input_error(found + " is no sensor model", "sensors[].model", "one of " + known);
}

const char* name_of(Pour::Finish finish) {
  switch (finish) {
    case Pour::Finish::settled:
      return "settled";
    case Pour::Finish::pressed:
      return "pressed";
    case Pour::Finish::probed:
      return "probed";
  }
  return "?";
}

std::size_t Request::part_count() const {
  std::size_t n = 0;
  for (const PartLine& line : parts) n += line.count;
  return n;
}

void apply(SolverSettings::Preset preset, Request& request) {
  request.solver.preset = preset;
  if (preset != SolverSettings::Preset::quick) return;
  request.pour.finish = Pour::Finish::settled;
  request.pour.drop_height = 0.005;
  SphereSettings& sphere = request.solver.sphere;
  sphere.time_step = 1.0 / 120.0;
  sphere.step_fall = 7.5e-3;
  sphere.sub_steps = 1;
  sphere.recycle = 5e-3;
  sphere.coarse_samples = 60;
  sphere.fine_samples = 0;
  sphere.field_cell = 0.02;
}

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::size_t max_parts = 1000000;
constexpr std::size_t max_labels = 65534;  // labels are 16 bit, 0 is the background and 65535 is kept free

std::string text(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

/// `key` is the path of the field as the request file spells it: whoever read the request knows its line.
[[noreturn]] void refuse(const std::string& key, const std::string& what, const std::string& remedy) {
  throw input_error(what, key, remedy);
}

enum class Lower { included, excluded };

/// A finite number within bounds.
void number(const std::string& key, double value, Lower kind, double lower, double upper, const char* remedy) {
  const bool in = std::isfinite(value) && value <= upper && (kind == Lower::included ? value >= lower : value > lower);
  if (in) return;
  std::string expected = std::string("must be ") + (kind == Lower::included ? "at least " : "above ") + text(lower);
  if (std::isfinite(upper)) expected += " and at most " + text(upper);
  refuse(key, expected + ", is " + text(value), remedy);
}
void at_least(const std::string& key, double value, double lower, double upper, const char* remedy) {
  number(key, value, Lower::included, lower, upper, remedy);
}
void above(const std::string& key, double value, double lower, double upper, const char* remedy) {
  number(key, value, Lower::excluded, lower, upper, remedy);
}

void check_pose(const std::string& key, const Pose& pose) {
  if (!pose.finite()) refuse(key, "is not finite", "give seven finite numbers");
  if (std::abs(pose.orientation.squaredNorm() - 1.0) > 1e-6) refuse(key, "has no unit quaternion", "normalise it");
  if (pose.position.norm() > 1e4) refuse(key, "lies " + text(pose.position.norm()) + " m away", "positions are in m");
}

void check_surface(const std::string& key, const Surface& surface) {
  at_least(key + ".albedo", surface.albedo, 0.0, 1.0, "share of the light that is sent back");
  at_least(key + ".gloss", surface.gloss, 0.0, 1.0, "share that is mirrored");
  at_least(key + ".roughness", surface.roughness, 0.0, 1.0, "0.1 is polished, 0.4 machined, 1 matte");
}

void check_motion(const std::string& key, const Motion& motion) {
  if (motion.times.size() != motion.poses.size()) {
    refuse(
        key + ".times",
        "has " + std::to_string(motion.times.size()) + " times for " + std::to_string(motion.poses.size()) + " poses",
        "give one time a pose");
  }
  for (std::size_t i = 0; i < motion.times.size(); ++i) {
    const std::string item = "[" + std::to_string(i) + "]";
    above(key + ".times" + item, motion.times[i], i == 0 ? 0.0 : motion.times[i - 1], 1e5, "s, ascending");
    check_pose(key + ".poses" + item, motion.poses[i]);
  }
  const auto vector = [&](const char* name, const Vec3& value, double most, const char* unit) {
    if (!value.allFinite()) refuse(key + name, "is not finite", "give three finite numbers");
    at_least(key + name, value.norm(), 0.0, most, unit);
  };
  vector(".shake", motion.shake, 100.0, "m");
  vector(".tilt", motion.tilt, M_PI, "rad");
  vector(".belt", motion.belt, 100.0, "m/s");
  above(key + ".frequency", motion.frequency, 0.0, 100.0, "Hz");
  above(key + ".seconds", motion.seconds, 0.0, 1e5, "simulated seconds");
}

void check_bin(const Bin& bin) {
  check_motion("bin.motion", bin.motion);
  if (!bin.motion.belt.isZero()) refuse("bin.motion.belt", "is of parts only", "make the conveyor a fixed part");
  if (!bin.motion.poses.empty() && bin.motion.poses.back().orientation.vec().norm() > 1e-6) {
    refuse("bin.motion.poses", "does not end upright", "turn the bin back, or turn gravity instead");
  }
  check_surface("bin.surface", bin.surface);
  if (bin.kind == Bin::Kind::box) {
    for (int i = 0; i < 3; ++i) {
      above("bin.inner_size", bin.inner_size[i], 0.0, 1000.0, "inner length, width and height in m");
    }
    at_least("bin.wall_thickness", bin.wall_thickness, 0.0, 10.0, "m");
  }
  if (bin.kind == Bin::Kind::mesh) {
    if (bin.mesh.empty()) refuse("bin.mesh", "is empty", "name a mesh file");
    check_pose("bin.pose", bin.pose);
  }
  at_least("bin.friction", bin.friction, 0.0, 10.0, "0 is frictionless, steel on steel about 0.5");
  at_least("bin.restitution", bin.restitution, 0.0, 1.0, "0 does not bounce, 1 loses nothing");
}

void check_part(const std::string& key, const PartLine& line, Pour::Pattern pattern) {
  if (line.model.empty()) refuse(key + ".model", "is missing", "name a mesh file");
  above(key + ".scale", line.scale, 0.0, 1e6, "1 leaves the model as it is");
  at_least(key + ".count", static_cast<double>(line.count), 1, max_parts, "number of copies");
  if (line.density && line.mass) refuse(key + ".mass", "is given beside density", "keep one of them");
  if (line.density) above(key + ".density", *line.density, 0.0, 1e5, "kg/m3: water 1000, steel 7850");
  if (line.mass) above(key + ".mass", *line.mass, 0.0, 1e6, "kg, of one part");
  at_least(key + ".friction", line.friction, 0.0, 10.0, "0 is frictionless, steel on steel about 0.5");
  at_least(key + ".restitution", line.restitution, 0.0, 1.0, "0 does not bounce, 1 loses nothing");
  check_surface(key + ".surface", line.surface);
  if (line.thickness) above(key + ".thickness", *line.thickness, 0.0, 1.0, "wall thickness in m");
  if (!line.poses.empty() && line.poses.size() != line.count) {
    refuse(key + ".poses",
           "has " + std::to_string(line.poses.size()) + " poses for " + std::to_string(line.count) + " parts",
           "give one pose a part");
  }
  for (std::size_t i = 0; i < line.poses.size(); ++i) {
    check_pose(key + ".poses[" + std::to_string(i) + "]", line.poses[i]);
  }
  if (!line.velocities.empty() && line.velocities.size() != line.poses.size()) {
    refuse(key + ".velocities",
           "has " + std::to_string(line.velocities.size()) + " velocities for " + std::to_string(line.poses.size()) +
               " poses",
           "give one velocity a pose");
  }
  for (std::size_t i = 0; i < line.velocities.size(); ++i) {
    const Twist& v = line.velocities[i];
    const std::string where = key + ".velocities[" + std::to_string(i) + "]";
    if (!v.linear.allFinite() || !v.angular.allFinite()) refuse(where, "is not finite", "give six finite numbers");
    at_least(where, std::max(v.linear.norm(), v.angular.norm()), 0.0, 1e4, "m/s and rad/s");
  }
  check_motion(key + ".motion", line.motion);
  if (line.motion.any() && !line.fixed) refuse(key + ".motion", "is of a part that is not fixed", "set fixed: true");
  if (line.poses.empty() && line.fixed) {
    refuse(key + ".poses", "is missing for a fixed part", "say where it stands: [[x, y, z, qx, qy, qz, qw]]");
  }
  if (line.poses.empty() && pattern == Pour::Pattern::given) {
    refuse(key + ".poses", "is missing for pour.pattern given", "give one pose a part, or pour.scene");
  }
  if (!line.poses.empty() && !line.fixed && pattern != Pour::Pattern::given) {
    refuse(key + ".poses", std::string("would not be used: the parts are poured"),
           "set pour.pattern: given, or fixed: true for an obstacle");
  }
}

void check_pour(const Pour& pour) {
  at_least("pour.drop_height", pour.drop_height, 0.0, 100.0, "m");
  at_least("pour.grid_spacing", pour.grid_spacing, 1.0, 100.0, "below 1 the parts overlap");
  above("pour.limit", pour.limit, 0.0, 1e5, "simulated seconds");
  above("pour.rest_window", pour.rest_window, 0.0, pour.limit, "simulated seconds, at most pour.limit");
  above("pour.rest_move", pour.rest_move, 0.0, 1.0, "fraction of the part's diagonal");
  above("pour.rest_turn", pour.rest_turn, 0.0, 3.2, "rad");
}

void check_solver(const SolverSettings& solver) {
  const char* step = "s; 1/240 is usual";
  const BulletSettings& b = solver.bullet;
  above("solver.bullet.time_step", b.time_step, 0.0, 0.1, step);
  at_least("solver.bullet.iterations", b.iterations, 1, 10000, "sweeps per step");
  above("solver.bullet.margin", b.margin, 0.0, 0.2, "fraction of the part's diagonal");
  above("solver.bullet.hull_error", b.hull_error, 0.0, 1.0, "fraction of the part's diagonal");
  above("solver.bullet.hull_volume_error", b.hull_volume_error, 0.0, 10.0, "fraction of the part's volume");
  at_least("solver.bullet.max_hulls", b.max_hulls, 1, 4096, "hulls per part");
  const ThesisSettings& t = solver.thesis;
  above("solver.thesis.time_step", t.time_step, 0.0, 0.1, step);
  at_least("solver.thesis.sub_steps", t.sub_steps, 1, 1000, "steps per time step");
  at_least("solver.thesis.iterations", t.iterations, 1, 10000, "passes per step");
  at_least("solver.thesis.bias", t.bias, 0.0, 1.0, "0.1 to 0.3 is usual");
  at_least("solver.thesis.slop", t.slop, 0.0, 1.0, "fraction of the sphere radius");
  at_least("solver.thesis.rest_velocity", t.rest_velocity, 0.0, 100.0, "m/s; 0 = 2 g time_step");
  at_least("solver.thesis.voxels", t.voxels, 1, 512, "voxels along the longest side");
  above("solver.thesis.tightness", t.tightness, 0.0, 1.0, "voxel pitch / sphere diameter");
  for (std::size_t i = 0; i < t.radii.size(); ++i) {
    const std::string key = "solver.thesis.radii[" + std::to_string(i) + "]";
    at_least(key, t.radii[i], 0.5 / 512, 0.5, "of the part's longest side; half of it fills a ball");
    if (i > 0 && t.radii[i] >= t.radii[i - 1]) refuse(key, "is no smaller than the one before", "largest first");
  }
  at_least("solver.thesis.grid_size", t.grid_size, 1, 1024, "cells per axis");
  at_least("solver.thesis.cell_size", t.cell_size, 1.0, 1000.0, "sphere diameters");
  at_least("solver.thesis.contacts_per_sphere", t.contacts_per_sphere, 1, 1024, "4 in the thesis");
  const SphereSettings& s = solver.sphere;
  above("solver.sphere.time_step", s.time_step, 0.0, 0.1, step);
  at_least("solver.sphere.sub_steps", s.sub_steps, 1, 1000, "solves per time step");
  at_least("solver.sphere.coarse_samples", s.coarse_samples, 8, 1e6, "samples per part");
  if (s.fine_samples != 0)
    at_least("solver.sphere.fine_samples", s.fine_samples, 8, 1e6, "samples per part; 0 = the coarse ones");
  above("solver.sphere.step_fall", s.step_fall, 0.0, 1.0, "fraction of the part's diagonal");
  above("solver.sphere.recycle", s.recycle, 0.0, 0.1, "fraction of the part's diagonal");
  above("solver.sphere.field_cell", s.field_cell, 0.0, 0.25, "fraction of the part's diagonal");
}

void check_distortion(const std::string& key, const std::array<double, 5>& distortion) {
  for (const double d : distortion) at_least(key, d, -100.0, 100.0, "[k1, k2, p1, p2, k3], as CameraInfo has them");
}

void check_baseline(const std::string& key, double baseline) {
  if (baseline == 0.0) refuse(key, "is 0: without it there is no triangle to measure with", "0.1 to 0.3 m is usual");
  at_least(key, baseline, -100.0, 100.0, "m along the camera's x; negative = to its left");
}

/// What only some models use is checked whatever the model: a mistake in it must not wait for a change of model.
void check_light(const std::string& key, const Sensor& sensor) {
  const Projector& projector = sensor.projector;
  if (projector.pose) check_pose(key + ".projector.pose", *projector.pose);
  check_baseline(key + ".projector.baseline", projector.baseline);
  at_least(key + ".projector.width", projector.width, 1, 16384, "pixels");
  at_least(key + ".projector.height", projector.height, 1, 16384, "pixels");
  above(key + ".projector.fov", projector.fov, 0.0, 3.1, "horizontal field of view in rad");
  check_distortion(key + ".projector.distortion", projector.distortion);
  const Laser& laser = sensor.laser;
  if (laser.pose) check_pose(key + ".laser.pose", *laser.pose);
  check_baseline(key + ".laser.baseline", laser.baseline);
  above(key + ".laser.width_mm", laser.width_mm, 0.0, 100.0, "mm; 0.1 to 0.5 is usual");
  const Scan& scan = sensor.scan;
  if (!scan.direction.allFinite() || !(scan.direction.norm() > 0.0)) {
    refuse(key + ".scan.direction", "is no direction", "for instance [1, 0, 0]");
  }
  above(key + ".scan.step", scan.step, 0.0, 10.0, "m between two profiles");
  at_least(key + ".scan.profiles", scan.profiles, 1, 65536, "rows of the image");
}

void check_sensor(const std::string& key, const Sensor& sensor) {
  const std::string& name = sensor.name;
  bool plain = !name.empty() && name.size() <= 100;
  for (const char c : name) plain &= std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-';
  if (!plain) refuse(key + ".name", "is '" + name + "'", "letters, digits, _ and -: it names frames and files");
  at_least(key + ".width", sensor.width, 1, 16384, "pixels");
  at_least(key + ".height", sensor.height, 1, 16384, "pixels");
  above(key + ".fov", sensor.fov, 0.0, 3.1, "horizontal field of view in rad");
  if (!sensor.k.empty()) {
    const std::vector<double>& k = sensor.k;
    bool good = k.size() == 9;
    for (const double value : k) good &= std::isfinite(value);
    good = good && k[0] > 0 && k[4] > 0 && k[3] == 0 && k[6] == 0 && k[7] == 0 && k[8] == 1;
    if (!good) refuse(key + ".k", "is no matrix of intrinsics", "[fx, 0, cx, 0, fy, cy, 0, 0, 1] in pixels");
    if (k[1] != 0) refuse(key + ".k", "has a skew, which no image is made with", "set its second number to 0");
  }
  check_distortion(key + ".distortion", sensor.distortion);
  if (sensor.pose) check_pose(key + ".pose", *sensor.pose);
  check_light(key, sensor);
  check_sensor_models(key, sensor);
  above(key + ".near", sensor.near, 0.0, infinity, "m");
  above(key + ".far", sensor.far, sensor.near, 1e4, "m, beyond near");
}

}  // namespace

void check(const Request& request) {
  at_least("scenes", static_cast<double>(request.scenes), 1, 1e9, "number of scenes");
  at_least("first", static_cast<double>(request.first), 0, 1e9, "index of the first scene");
  check_bin(request.bin);
  if (!request.gravity.allFinite()) refuse("gravity", "is not finite", "give three finite numbers");
  at_least("gravity", request.gravity.norm(), 0.0, 1e4, "m/s2; the earth's is [0, 0, -9.81]");
  if (request.parts.empty()) refuse("parts", "is missing or empty", "list at least one model");
  for (std::size_t i = 0; i < request.parts.size(); ++i) {
    check_part("parts[" + std::to_string(i) + "]", request.parts[i], request.pour.pattern);
  }
  if (request.part_count() > max_parts) {
    refuse("parts",
           "asks for " + std::to_string(request.part_count()) + " parts a scene, at most " + std::to_string(max_parts) +
               " are possible",
           "lower the counts");
  }
  if (!request.sensors.empty() && request.part_count() > max_labels) {
    refuse("parts",
           "asks for " + std::to_string(request.part_count()) + " parts, but the 16-bit labels of a sensor tell " +
               std::to_string(max_labels) + " apart",
           "lower the counts, or remove the sensors");
  }
  check_pour(request.pour);
  check_solver(request.solver);
  std::set<std::string> names;
  for (std::size_t i = 0; i < request.sensors.size(); ++i) {
    const std::string key = "sensors[" + std::to_string(i) + "]";
    check_sensor(key, request.sensors[i]);
    if (!names.insert(graph_name(request.sensors[i].name)).second) {
      refuse(key + ".name", "'" + request.sensors[i].name + "' names an earlier sensor too",
             "name each differently; a hyphen counts as an underscore, which topics and frames have in its place");
    }
  }
  at_least("accept.penetration", request.accept.penetration, 0.0, 1.0, "fraction of the part's diagonal");
  at_least("accept.gap", request.accept.gap, 0.0, 1.0, "fraction of the part's diagonal");
  at_least("accept.energy", request.accept.energy, 0.0, infinity, "multiples of mass * gravity * diagonal");
  at_least("accept.speed", request.accept.speed, 1.0, infinity, "multiples of the fastest speed before");
  if (request.seconds) above("seconds", *request.seconds, 0.0, 1e5, "simulated seconds");
  above("memory_budget", request.memory_budget, 0.0, 1e15, "bytes");
}

}  // namespace bin_scenes
