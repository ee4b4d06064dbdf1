/// Thinning of poses. Two poses are equivalent if they are near each other, or if a symmetry of the part or of the
/// gripper moves one of them near the other.
#pragma once

#include "bin_scenes/grasp/part_grasps.hpp"
#include "bin_scenes/part/symmetry.hpp"

#include <limits>
#include <vector>

namespace bin_scenes {

class PoseMeasure {
 public:
  /// @param symmetries  symmetries of the part; empty: poses that are equal by a symmetry are distinguished
  PoseMeasure(const Symmetries& symmetries, Gripper::Type type);

  struct Limits {
    double apart = 0.0, angle = 0.0;  ///< distance of positions (m) and angle of orientations (rad) that count as 1
  };
  /// Returns the larger one of distance / Limits::apart and angle / Limits::angle of two poses, for the symmetry that
  /// makes it smallest. If it is at least `enough`, the result may be any value of at least `enough`.
  double distance(const Pose& a, const Pose& b, const Limits& limits,
                  double enough = std::numeric_limits<double>::infinity()) const;
  /// Returns the images of a pose under all symmetries: the smallest plain_distance of b from one of them is
  /// distance(a, b). Empty if there is an axis of rotational symmetry, because the rotation then depends on b.
  std::vector<Pose> mapped(const Pose& a) const;
  double plain_distance(const std::vector<Pose>& mapped, const Pose& b, const Limits& limits, double enough) const;
  bool near(const Pose& a, const Pose& b, const Limits& limits) const { return distance(a, b, limits, 1.0) < 1.0; }
  /// Returns all images of a pose under the symmetries, the pose itself first; rotations in steps of the limits.
  std::vector<Pose> images(const Pose& pose, const Limits& limits) const;

 private:
  double angle_between(const Quat& a, const Quat& b) const;
  Quat about_axis(const Pose& a, const Pose& b, double arm) const;

  std::vector<Pose> maps_;  ///< the identity, then the discrete symmetries of the part
  std::vector<Symmetries::Axis> axes_;
  Gripper::Type type_;
};

/// Returns the indices of chosen poses. The first ones cover all poses coarsely, later ones ever more finely, until no
/// pose is farther than the limits from a chosen one. Within one cover, earlier poses come first. The first n indices
/// are the same for each value of `most`, the largest number of indices.
std::vector<std::size_t> thin(const std::vector<Pose>& poses, const PoseMeasure& measure,
                              const PoseMeasure::Limits& limits, std::size_t most);

}  // namespace bin_scenes
