/// Poses that are as good as one: near each other, or made so by a symmetry of the part or of the gripper.
#pragma once

#include "bin_scenes/grasp/part_grasps.hpp"
#include "bin_scenes/part/symmetry.hpp"

#include <limits>
#include <vector>

namespace bin_scenes {

class PoseMeasure {
 public:
  /// @param symmetries  of the part; empty: poses are kept apart that symmetries make alike
  PoseMeasure(const Symmetries& symmetries, Gripper::Type type);

  struct Limits {
    double apart = 0.0, angle = 0.0;  ///< m, rad
  };
  /// Distance of b from a in units of the limits, the least over all symmetries: the larger one of place and angle.
  /// What is at least `enough` may be returned as any such value.
  double distance(const Pose& a, const Pose& b, const Limits& limits,
                  double enough = std::numeric_limits<double>::infinity()) const;
  /// Poses from which the symmetries' distance is the plain one: the least of plain distances from them is distance().
  /// Empty where a round axis has to be turned for each pair.
  std::vector<Pose> mapped(const Pose& a) const;
  double plain_distance(const std::vector<Pose>& mapped, const Pose& b, const Limits& limits, double enough) const;
  bool near(const Pose& a, const Pose& b, const Limits& limits) const { return distance(a, b, limits, 1.0) < 1.0; }
  /// All places to which symmetries bring a pose, the pose itself first; round axes in steps of the limits.
  std::vector<Pose> images(const Pose& pose, const Limits& limits) const;

 private:
  double angle_between(const Quat& a, const Quat& b) const;
  Quat about_axis(const Pose& a, const Pose& b, double arm) const;

  std::vector<Pose> maps_;  ///< the identity first
  std::vector<Symmetries::Axis> axes_;
  Gripper::Type type_;
};

/// Indices of poses, a coarse cover of all first, then ever finer ones until none is farther than the limits from those
/// chosen. Within one cover, earlier poses go first. The first n of the result do not depend on `most`.
std::vector<std::size_t> thin(const std::vector<Pose>& poses, const PoseMeasure& measure,
                              const PoseMeasure::Limits& limits, std::size_t most);

}  // namespace bin_scenes
