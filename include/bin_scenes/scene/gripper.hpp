/// A gripper of a request: what closes on a part or sucks it, as boxes and a cup. SI units. Meaning, unit and range of
/// a field that is a key are in the table of keys (src/scene/gripper_keys.hpp); comments here are of fields that are
/// none.
///
/// Gripper frame: z is the direction of approach, from the gripper towards the part; x the direction in which fingers
/// close. The origin is the centre between the pads, or of the cup's ring where it touches the surface.
#pragma once

#include "bin_scenes/core/types.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace bin_scenes {

/// Weights of the columns of a grasp (grasp/score.hpp), calibrated by bench/datasets/calibration: score = 1 / (1 +
/// exp(-(bias + sum of weight * column))).
struct ScoreWeights {
  double bias = -0.6;
  double holding = 1.0;
  double sliding = 2.3;
  double antipodal = 0.125;
  double moment = 0.25;
  double overlap = 0.25;
  double upright = 0.375;
  double clearance = 0.125;
  double closing = 0.25;
  double seen = 0.0625;
  double measured = 0.0625;
};

/// Where the pads of two fingers touch a part.
struct Aperture {
  double width = 0.0;  ///< m between the surfaces that the pads touch
  bool inner = false;  ///< the fingers are between these surfaces and press outwards, as in a ring or tube
};

struct Gripper {
  enum class Type {
    parallel,  ///< two fingers that close along a line
    suction    ///< one round cup
  };
  std::string name;
  std::string preset;
  Type type = Type::parallel;
  std::optional<double> stroke;
  double opening = 0.005;
  double finger_width = 0.012;
  double finger_depth = 0.05;
  double finger_thickness = 0.01;
  std::string finger_mesh;
  double finger_mesh_scale = 1.0;
  std::vector<Aabb> finger_boxes;  ///< m: around that shape, filled when the request is loaded; empty: one box
  double pad_length = 0.012;
  double pad_give = 2e-4;
  double radius = 0.01;
  double lip = 0.001;
  double stiffness = 200.0;
  Vec3 palm = Vec3(0.1, 0.06, 0.1);
  double force = 50.0;
  double friction = 0.5;
  double clearance = 0.001;
  double finger_clearance = 5e-4;
  double margin = 0.001;
  bool inner = false;
  Vec3 tool_rotation = Vec3::Zero();
  double acceleration = 2.0;
  double tilt = 0.8;
  std::size_t most = 200;
  std::size_t free_wanted = 5;
  std::size_t tries = 600;
  ScoreWeights score;

  double travel() const { return stroke.value_or(type == Type::parallel ? 0.05 : 0.5 * radius); }
  /// m, parallel: range of the widths of parts that the opened fingers can pass, or of holes that they can enter.
  double widest() const { return travel() - 2.0 * finger_clearance; }
  double narrowest_hole() const { return 2.0 * (finger_thickness + finger_clearance); }
  double widest_hole() const { return travel() + 2.0 * finger_thickness; }
  /// m, parallel: between the inner faces of the fingers.
  double between_fingers(const Aperture& at) const { return at.inner ? at.width - 2.0 * finger_thickness : at.width; }
  /// m, parallel: by how much each finger is away from the part before it closes, or expands.
  double opened(const Aperture& at) const;
  /// Of the gripper's frame in that of the flange.
  Quat tool_orientation() const;
  /// Of the flange in the gripper's frame: the centre of the palm's back, with z towards the tool.
  Pose flange() const;
};

/// Throws an input Error at `key` for lengths that are no gripper's (which names the likely unit), or that contradict
/// each other.
void check_gripper(const Gripper& gripper, const std::string& key);

}  // namespace bin_scenes
