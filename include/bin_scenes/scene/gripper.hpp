/// A gripper of a request: what closes on a part or sucks it, as boxes and a cup. SI units.
///
/// Gripper frame: z is the direction of approach, from the gripper towards the part; x the direction in which fingers
/// close. The origin is the middle between the pads, or of the cup's ring where it touches the surface.
#pragma once

#include "bin_scenes/core/types.hpp"

#include <cstddef>
#include <optional>
#include <string>

namespace bin_scenes {

/// Weights of the columns of a grasp (grasp/score.hpp): score = 1 / (1 + exp(-(bias + sum of weight * column))).
struct ScoreWeights {
  double bias = 0.4;
  double holding = 2.75;     ///< of ln(safety factor against slip), limited to +-ln 4
  double antipodal = 0.125;  ///< of the share of friction that the slope of the contacts leaves
  double moment = 0.25;      ///< of 1 - sqrt(moment of the weight / moment that is held)
  double overlap = 0.25;     ///< of the contact: share of the pads in contact, margin of a cup's ring
  double upright = 0.375;    ///< of 1 - tilt / 90 degrees
  double clearance = 0.125;  ///< of the room around the gripper: 1 where four clearances are free
  double closing = 0.25;     ///< of 1 - width / stroke
  double seen = 0.0625;      ///< of the share of the contact that the best camera sees
  double measured = 0.0625;  ///< of the share of the contact that the best camera measured
};

struct Gripper {
  enum class Type {
    parallel,  ///< two fingers that close along a line
    suction    ///< one round cup
  };
  std::string name;    ///< in outputs; empty: the preset's
  std::string preset;  ///< name of the preset the values come from; read by config/, has no effect of its own
  Type type = Type::parallel;
  std::optional<double> stroke;      ///< m. parallel: largest distance of the pads, none = 0.05; suction: how far the
                                     ///< bellows adapts to a tilted surface, none = half the radius
  double opening = 0.005;            ///< m, parallel: by which each finger is wider than the part before it closes
  double finger_width = 0.012;       ///< m, parallel: of finger and pad, across closing and approach
  double finger_depth = 0.05;        ///< m: from the palm to the tip of the fingers or the ring of the cup
  double finger_thickness = 0.01;    ///< m, parallel: along closing
  double pad_length = 0.012;         ///< m, parallel: of the pad, from the tip towards the palm
  double pad_give = 2e-4;            ///< m, parallel: by which the pad yields; what lies no deeper is in contact
  double radius = 0.01;              ///< m, suction: of the ring
  double lip = 0.001;                ///< m, suction: largest gap between ring and surface that the lip closes
  double stiffness = 200.0;          ///< N/m, suction: of the ring against being pressed into its gap
  Vec3 palm = Vec3(0.1, 0.06, 0.1);  ///< m: box behind the fingers: along closing, across it, along approach
  double force = 50.0;               ///< N. parallel: of each finger; suction: of the vacuum
  double friction = 0.5;             ///< of pad or ring; pair coefficient = sqrt(gripper * part)
  double clearance = 0.001;          ///< m to everything but the part itself
  double finger_clearance = 5e-4;    ///< m, parallel: least gap between each opened finger and the part, so that the
                                     ///< widest part is stroke - 2 * finger_clearance
  double margin = 0.001;             ///< m, suction: least distance of the ring from edges and holes
  double acceleration = 2.0;         ///< m/s2 of the lift; adds to gravity
  double tilt = 0.8;                 ///< rad: largest angle between approach and gravity
  std::size_t most = 200;            ///< grasps of a part that every scene tries, spread over the part
  std::size_t free_wanted = 5;       ///< free grasps of an uncovered part after which a scene's own search ends
  std::size_t tries = 600;           ///< poses of an uncovered part after which it ends in any case
  ScoreWeights score;

  double travel() const { return stroke.value_or(type == Type::parallel ? 0.05 : 0.5 * radius); }
  /// m, parallel: width of a part that the opened fingers can pass.
  double widest() const { return travel() - 2.0 * finger_clearance; }
};

/// Throws an input Error at `key` for lengths that are no gripper's (which names the likely unit), or that contradict
/// each other.
void check_gripper(const Gripper& gripper, const std::string& key);

}  // namespace bin_scenes
