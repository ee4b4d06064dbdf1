#include "bin_scenes/scene/gripper.hpp"

#include "bin_scenes/core/error.hpp"
#include "core/formatted.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace bin_scenes {

namespace {

// What grippers for bins are built like, with room to spare. Millimetres taken for metres lie far outside.
constexpr double longest = 2.0, shortest = 1e-4;  // m
constexpr double widest_clearance = 0.2;          // m

// Fitted to lifts by bench/datasets/calibration. The vacuum of a cup fails within a narrow range of loads, whereas a
// part may turn between fingers and be lifted all the same.
constexpr double bias_of_fingers = -0.4, holding_of_fingers = 1.0, sliding_of_fingers = 2.3;
constexpr double bias_of_cup = -1.4, holding_of_cup = 5.8, sliding_of_cup = 1.7;

std::string metres(double value) {
  return formatted("%.4g m", value);
}

/// The lengths that a type uses and that no gripper can do without.
std::vector<std::pair<const char*, double>> lengths(const Gripper& g) {
  std::vector<std::pair<const char*, double>> all;
  if (g.type == Gripper::Type::suction) {
    all = {{"radius", g.radius}};
  } else {
    all = {{"finger_width", g.finger_width}, {"finger_thickness", g.finger_thickness}, {"pad_length", g.pad_length}};
  }
  all.insert(all.end(), {{"stroke", g.travel()},
                         {"finger_depth", g.finger_depth},
                         {"palm[0]", g.palm.x()},
                         {"palm[1]", g.palm.y()},
                         {"palm[2]", g.palm.z()}});
  return all;
}

}  // namespace

ScoreWeights Gripper::weights() const {
  const bool cup = type == Type::suction;
  ScoreWeights all = score;
  all.bias = score.bias.value_or(cup ? bias_of_cup : bias_of_fingers);
  all.holding = score.holding.value_or(cup ? holding_of_cup : holding_of_fingers);
  all.sliding = score.sliding.value_or(cup ? sliding_of_cup : sliding_of_fingers);
  return all;
}

double Gripper::opened(const Aperture& at) const {
  const double room = at.inner ? between_fingers(at) : travel() - at.width;
  return std::min(opening, 0.5 * std::max(0.0, room));
}

Quat Gripper::tool_orientation() const {
  const auto turn = [&](int axis) { return Quat(Eigen::AngleAxisd(tool_rotation[axis], Vec3::Unit(axis))); };
  return turn(2) * turn(1) * turn(0);
}

Pose Gripper::flange() const {
  const double tip = type == Type::parallel ? 0.5 * pad_length : 0.0;
  const Quat axes = tool_orientation().conjugate();
  return {Vec3(0.0, 0.0, tip - finger_depth) - axes * Vec3(0.0, 0.0, palm.z()), axes};
}

void check_gripper(const Gripper& gripper, const std::string& key) {
  for (const auto& [name, value] : lengths(gripper)) {
    if (value > longest)
      throw input_error("is " + metres(value) + ", longer than any gripper for bins", key + "." + name,
                        "lengths are in m; for mm write " + metres(1e-3 * value));
    if (value < shortest)
      throw input_error("is " + metres(value) + ", shorter than any gripper's", key + "." + name,
                        "lengths are in m; perhaps " + metres(1e3 * value) + " is meant");
  }
  if (gripper.clearance > widest_clearance)
    throw input_error("is " + metres(gripper.clearance) + ", wider than any bin has room for", key + ".clearance",
                      "lengths are in m; for mm write " + metres(1e-3 * gripper.clearance));
  if (gripper.type == Gripper::Type::parallel) {
    if (gripper.pad_length > gripper.finger_depth)
      throw input_error("is longer than finger_depth, " + metres(gripper.finger_depth), key + ".pad_length",
                        "give at most this length, because the pad is a part of the finger");
    if (!(gripper.widest() > 0.0))
      throw input_error("twice this value leaves nothing of the stroke, " + metres(gripper.travel()),
                        key + ".finger_clearance", "lengths are in m; the default is 0.0005");
    return;
  }
  if (gripper.lip >= gripper.radius)
    throw input_error("is not smaller than the radius of the ring, " + metres(gripper.radius), key + ".lip",
                      "give the largest gap that the lip can close, which is about a tenth of the radius");
}

}  // namespace bin_scenes
