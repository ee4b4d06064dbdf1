/// A gripper of a request: two fingers that close on a part, described by boxes, or a suction cup. All values are in SI
/// units. Keys of the request are described in their table (src/scene/gripper_keys.hpp); the comments here describe
/// only the fields that are not keys. The search for grasps (grasp/) and their simulation (pour/prover.hpp) use this
/// struct.
///
/// Gripper frame: z is the direction of approach, from the gripper towards the part, and x is the direction in which
/// the fingers close. The origin is the centre between the two pads or, for a cup, the centre of the ring with which it
/// touches the surface.
#pragma once

#include "bin_scenes/core/types.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace bin_scenes {

/// Weights of the columns from which the score of a grasp is computed (grasp/score.hpp): score = 1 / (1 + exp(-(bias +
/// sum of weight * column))). bench/datasets/calibration fitted the first three, which differ between fingers and cups;
/// Gripper::weights() fills in those that are left out.
struct ScoreWeights {
  std::optional<double> bias, holding, sliding;
  double antipodal = 0.125;
  double moment = 0.25;
  double overlap = 0.25;
  double upright = 0.375;
  double clearance = 0.125;
  double closing = 0.4;
  double seen = 0.0625;
  double measured = 0.0625;
};

/// Where the pads of two fingers touch a part.
struct Aperture {
  double width = 0.0;  ///< m, distance between the two surfaces that the pads touch
  bool inner = false;  ///< the fingers are between these surfaces and press outwards, as in a ring or tube
};

/// One gripper with its dimensions, forces and limits of the search. Keys are described in the table.
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
  std::vector<Aabb> finger_boxes;  ///< m, boxes around the finger mesh in the gripper frame, filled in when the request
                                   ///< is loaded; empty: one box per finger
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

  /// m: by how much the opening of the fingers can change, or by how much a cup can be compressed.
  double travel() const { return stroke.value_or(type == Type::parallel ? 0.05 : 0.5 * radius); }
  /// Returns `score` with the defaults of the gripper's type where weights are left out.
  ScoreWeights weights() const;
  /// Parallel grippers, m: the largest width of a part that the opened fingers can pass, and the smallest and largest
  /// width of a hole that the fingers can enter.
  double widest() const { return travel() - 2.0 * finger_clearance; }
  double narrowest_hole() const { return 2.0 * (finger_thickness + finger_clearance); }
  double widest_hole() const { return travel() + 2.0 * finger_thickness; }
  /// Parallel grippers, m: the distance between the inner faces of the fingers when the pads touch the part.
  double between_fingers(const Aperture& at) const { return at.inner ? at.width - 2.0 * finger_thickness : at.width; }
  /// Parallel grippers, m: the distance of each finger from the part before the fingers close or expand.
  double opened(const Aperture& at) const;
  /// Returns the orientation of the gripper frame relative to the flange.
  Quat tool_orientation() const;
  /// Returns the pose of the flange in the gripper frame. Its origin is the centre of the back of the palm, and its z
  /// axis points towards the tool.
  Pose flange() const;
};

/// Throws an input Error that names `key` if a length is implausible for a gripper (the error then names the likely
/// unit) or if lengths contradict each other.
void check_gripper(const Gripper& gripper, const std::string& key);

}  // namespace bin_scenes
