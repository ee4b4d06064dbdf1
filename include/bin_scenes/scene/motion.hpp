/// Motion on a given path: of the bin, or of a fixed part (a pusher, a conveyor), which nothing can stop or turn aside.
#pragma once

#include "bin_scenes/core/types.hpp"

#include <vector>

namespace bin_scenes {

/// What a body does, told from the pose where it stands: along a path, shaken about it, or as a belt that stays in its
/// place. It begins once all parts are in and slow (given parts: at once), and begins and ends at rest.
struct Motion {
  std::vector<double> times;  ///< s from the beginning, ascending, above 0: when it is at each of `poses`
  std::vector<Pose> poses;    ///< where it is then, from where it stood (m, bin frame at the beginning), smooth between
  Vec3 shake = Vec3::Zero();  ///< m: amplitude of a sine
  Vec3 tilt = Vec3::Zero();   ///< rad about the axes: amplitude of a sine of turns about the origin
  double frequency = 2.0;     ///< Hz of shake and tilt, which swell up over their first period and fade over their last
  Vec3 belt = Vec3::Zero();   ///< m/s: velocity of a part's surface, while the part itself stays
  double seconds = 1.0;       ///< of shake, tilt and belt

  bool any() const { return !times.empty() || !shake.isZero() || !tilt.isZero() || !belt.isZero(); }
  double duration() const;  ///< s; 0: it does not move
  Pose at(double t) const;  ///< displacement t seconds (any number) after the beginning
};

}  // namespace bin_scenes
