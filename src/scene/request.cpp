/// Names of enumerations, presets, and check(): what no single key can decide, such as counts together or a start
/// without poses. Ranges of keys are checked by range_check.hpp.
#include "bin_scenes/scene/request.hpp"

#include "bin_scenes/core/error.hpp"
#include "scene/keys.hpp"
#include "scene/range_check.hpp"

#include <algorithm>
#include <set>
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
  return name_in_table(unit);
}

const char* name_of(SolverType type) {
  return name_in_table(type);
}

const char* name_of(Pour::Finish finish) {
  return name_in_table(finish);
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
  request.accept.penetration = 0.015;
  request.accept.worst_penetration = 0.1;
  SphereSettings& sphere = request.solver.sphere;
  sphere.time_step = 1.0 / 120.0;
  sphere.step_fall = 7.5e-3;
  sphere.sub_steps = 1;
  sphere.recycle = 5e-3;
  sphere.pressed_recycle = 2e-4;
  sphere.coarse_samples = 100;
  sphere.fine_samples = 100;
  sphere.field_cell = 0.01;
}

namespace {

constexpr std::size_t max_parts = 1000000;
constexpr std::size_t max_labels = 65534;  // labels are 16 bit, 0 is the background and 65535 is kept free

/// `key` is the path of the field as the request file spells it: whoever read the request knows its line.
[[noreturn]] void refuse(const std::string& key, const std::string& what, const std::string& remedy) {
  throw input_error(what, key, remedy);
}

std::string count_of(std::size_t count, const char* what) {
  return std::to_string(count) + " " + what;
}

void check_motion(const std::string& key, const Motion& motion) {
  if (motion.times.size() != motion.poses.size()) {
    refuse(key + ".times",
           "has " + count_of(motion.times.size(), "times") + " for " + count_of(motion.poses.size(), "poses"),
           "give one time for each pose");
  }
  for (std::size_t i = 1; i < motion.times.size(); ++i) {
    if (!(motion.times[i] > motion.times[i - 1]))
      refuse(key + ".times[" + std::to_string(i) + "]", "is not later than the time before it",
             "give the times in ascending order");
  }
}

/// Whether gravity in the bin is, at last, what it was at first.
bool ends_upright(const Motion& motion, const Vec3& gravity) {
  return motion.poses.empty() || (motion.poses.back().orientation * gravity - gravity).norm() <= 1e-6 * gravity.norm();
}

void check_bin(const Bin& bin, const Vec3& gravity) {
  check_motion("bin.motion", bin.motion);
  if (!bin.motion.belt.isZero())
    refuse("bin.motion.belt", "applies to parts only", "describe the conveyor as a fixed part");
  if (!ends_upright(bin.motion, gravity))
    refuse("bin.motion.poses", "the bin is not upright at the end of its motion",
           "turn the bin back, or change gravity instead");
  if (bin.kind == Bin::Kind::mesh && bin.mesh.empty()) refuse("bin.mesh", "is empty", "name a mesh file");
}

void check_table(const Request& request) {
  const Table& table = request.table;
  if (!table.height) {
    if (table.mottle > 0.0) refuse("table.height", "is missing", "give the z of the table in the bin frame (m)");
    return;
  }
  const Bin& bin = request.bin;
  if (bin.kind == Bin::Kind::floor)
    refuse("table.height", "has no effect, because the bin is an endless floor", "remove table or bin.floor");
  if (bin.kind == Bin::Kind::box && *table.height > -bin.wall_thickness + 1e-9)
    refuse("table.height", "is above the underside of the bin", "give at most -bin.wall_thickness");
}

void check_start(const std::string& key, const PartLine& line, Pour::Pattern pattern) {
  if (!line.poses.empty() && line.poses.size() != line.count) {
    refuse(key + ".poses", "has " + count_of(line.poses.size(), "poses") + " for " + count_of(line.count, "parts"),
           "give one pose for each part");
  }
  if (!line.velocities.empty() && line.velocities.size() != line.poses.size()) {
    refuse(key + ".velocities",
           "has " + count_of(line.velocities.size(), "velocities") + " for " + count_of(line.poses.size(), "poses"),
           "give one velocity for each pose");
  }
  if (line.poses.empty() && line.fixed) {
    refuse(key + ".poses", "is missing for a fixed part", "give its pose: [[x, y, z, qx, qy, qz, qw]]");
  }
  if (line.poses.empty() && pattern == Pour::Pattern::given && !line.stays()) {
    refuse(key + ".poses", "is missing for pour.pattern given", "give one pose for each part, or give pour.scene");
  }
  if (!line.poses.empty() && !line.stays() && pattern != Pour::Pattern::given) {
    refuse(key + ".poses", "has no effect, because the parts are poured",
           "set pour.pattern: given, or fixed: true for an obstacle");
  }
}

void check_part(const std::string& key, const PartLine& line, Pour::Pattern pattern) {
  if (line.model.empty()) refuse(key + ".model", "is missing", "name a mesh file");
  if (line.density && line.mass) refuse(key + ".mass", "is given in addition to density", "remove one of the two keys");
  check_start(key, line, pattern);
  check_motion(key + ".motion", line.motion);
  if (line.motion.any() && !line.fixed)
    refuse(key + ".motion", "belongs to parts that are not fixed", "set fixed: true");
}

void check_solver(const SolverSettings& solver) {
  const std::vector<double>& radii = solver.thesis.radii;
  for (std::size_t i = 1; i < radii.size(); ++i) {
    if (radii[i] >= radii[i - 1])
      refuse("solver.thesis.radii[" + std::to_string(i) + "]", "is not smaller than the radius before it",
             "give the radii in descending order, the largest first");
  }
  const int fine = solver.sphere.fine_samples;
  if (fine > 0 && fine < 8)
    refuse("solver.sphere.fine_samples", "must be 0 or at least 8, is " + std::to_string(fine),
           "with 0, the coarse samples are used");
}

void check_counts(const Request& request) {
  const std::size_t count = request.part_count();
  if (count > max_parts) {
    refuse(
        "parts",
        "asks for " + count_of(count, "parts in a scene, but at most ") + std::to_string(max_parts) + " are possible",
        "lower the counts");
  }
  if (!request.sensors.empty() && count > max_labels) {
    refuse("parts",
           "asks for " + count_of(count, "parts, but the 16-bit labels of a sensor can distinguish at most ") +
               std::to_string(max_labels),
           "lower the counts, or remove the sensors");
  }
}

void check_grippers(const Request& request) {
  if (request.prove > 0 && request.grippers.empty())
    refuse("prove", "requires simulated lifts, but the request has no grippers",
           "add for instance `grippers: [robotiq_2f_85]`");
  std::set<std::string> names;
  for (std::size_t i = 0; i < request.grippers.size(); ++i) {
    const Gripper& gripper = request.grippers[i];
    const std::string key = "grippers[" + std::to_string(i) + "]";
    if (gripper.name.empty()) refuse(key + ".name", "is missing", "give the gripper a name or a preset");
    if (!names.insert(gripper.name).second)
      refuse(key + ".name", "'" + gripper.name + "' is also the name of another gripper",
             "give each gripper a different name");
    check_gripper(gripper, key);
    // Closed on nothing, it must still go in.
    const double least = gripper.type == Gripper::Type::suction
                             ? 2.0 * gripper.radius
                             : std::max(2.0 * gripper.finger_thickness, gripper.finger_width);
    const Vec3& room = request.bin.inner_size;
    if (request.bin.kind == Bin::Kind::box && least > std::max(room.x(), room.y()))
      refuse(key, "'" + gripper.name + "' is wider than the bin", "check its lengths, which are in m");
  }
}

}  // namespace

void check(const Request& request) {
  Request copy = request;  // visitors take references to fields that are not const, because one of them reads
  RangeCheck ranges;
  visit(ranges, copy);
  check_bin(request.bin, request.gravity);
  check_table(request);
  if (request.parts.empty()) refuse("parts", "is missing or empty", "list at least one model");
  for (std::size_t i = 0; i < request.parts.size(); ++i) {
    const std::string key = "parts[" + std::to_string(i) + "]";
    check_part(key, request.parts[i], request.pour.pattern);
    if (i > 0 && request.parts[i - 1].distractor && !request.parts[i].distractor)
      refuse(key, "comes after distractors", "list distractors last, so that the ids of the other parts have no gaps");
    if (request.parts[i].on_table > 0.0 && !request.table.height)
      refuse(key + ".on_table", "needs a table", "give table.height");
  }
  check_counts(request);
  check_grippers(request);
  if (request.pour.rest_window > request.pour.limit)
    refuse("pour.rest_window", "is longer than pour.limit", "shorten it, or raise pour.limit");
  check_solver(request.solver);
}

}  // namespace bin_scenes
