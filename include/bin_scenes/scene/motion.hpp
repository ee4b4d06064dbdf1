/// Motion on a given path, of the bin or of a fixed part (a pusher, a conveyor). Nothing can stop or deflect it.
#pragma once

#include "bin_scenes/core/types.hpp"

#include <vector>

namespace bin_scenes {

/// What a body does, relative to the pose where it stands: along a path, shaken about it, or as a belt that stays in
/// its place. It begins once all parts are in and slow (given parts: at once), and begins and ends at rest.
struct Motion {
  std::vector<double> times;
  std::vector<Pose> poses;
  Vec3 shake = Vec3::Zero();
  Vec3 tilt = Vec3::Zero();
  double frequency = 2.0;
  Vec3 belt = Vec3::Zero();
  double seconds = 1.0;

  bool any() const { return !times.empty() || !shake.isZero() || !tilt.isZero() || !belt.isZero(); }
  double duration() const;  ///< s; 0: it does not move
  Pose at(double t) const;  ///< displacement t seconds (any number) after the beginning
};

}  // namespace bin_scenes
