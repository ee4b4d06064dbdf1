/// Prescribed motion of the bin or of a fixed part, such as a pusher or a conveyor. Nothing can stop or deflect such a
/// body. Keys are described in their table (src/scene/keys.hpp).
#pragma once

#include "bin_scenes/core/types.hpp"

#include <vector>

namespace bin_scenes {

/// The motion of a body relative to its initial pose: along a path of given poses, shaken about that pose, or as a belt
/// whose surface moves while the body stays in place. The motion begins when all parts are in the bin and slow (with
/// given start poses: at once). It begins and ends at rest.
struct Motion {
  std::vector<double> times;
  std::vector<Pose> poses;
  Vec3 shake = Vec3::Zero();
  Vec3 tilt = Vec3::Zero();
  double frequency = 2.0;
  Vec3 belt = Vec3::Zero();
  double seconds = 1.0;

  bool any() const { return !times.empty() || !shake.isZero() || !tilt.isZero() || !belt.isZero(); }
  double duration() const;  ///< s; 0 if the body does not move
  /// Returns the displacement from the initial pose, `t` seconds after the motion began; `t` may be any number.
  Pose at(double t) const;
};

}  // namespace bin_scenes
