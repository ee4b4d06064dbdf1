/// Decides from the poses over a window of simulated time whether a body is at rest. The decision does not depend on
/// the velocities or the sleep of a solver, so that it is the same for all solvers.
#pragma once

#include "bin_scenes/core/types.hpp"

#include <vector>

namespace bin_scenes {

/// A body is at rest if all its poses of the last `window` seconds are within `move` and `turn` of one pose. Slow creep
/// and swinging both count as motion, in all directions and about all axes.
class RestWatch {
 public:
  struct Limits {
    double window = 0.25;  ///< length of the window of simulated time (s)
    double move = 0.0;     ///< largest displacement of the centre of mass (m)
    double turn = 0.0;     ///< largest rotation (rad)
  };

  explicit RestWatch(std::size_t bodies) : bodies_(bodies) {}

  /// Records the pose of a body at `time` (s). @param center  its centre of mass, bin frame (m)
  void observe(std::size_t body, double time, const Vec3& center, const Quat& orientation, const Limits& limits);
  bool resting(std::size_t body) const { return bodies_[body].resting; }
  /// Returns the time (s) since a body last moved.
  double still(std::size_t body, double time) const { return bodies_[body].seen ? time - bodies_[body].since : 0.0; }

 private:
  struct Body {
    bool seen = false, resting = false;
    double since = 0.0;  ///< time of the reference pose (s)
    Vec3 center = Vec3::Zero();
    Quat orientation = Quat::Identity();
  };
  std::vector<Body> bodies_;
};

}  // namespace bin_scenes
