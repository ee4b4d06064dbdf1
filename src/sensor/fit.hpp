/// Fits balls and planes to points by least squares, for the quality figures of sensors (sensor/metrics.hpp). The
/// residuals are returned as well, because the quality figures are computed from them.
#pragma once

#include "bin_scenes/core/types.hpp"

#include <vector>

namespace bin_scenes {

struct BallFit {
  Vec3 center = Vec3::Zero();
  double radius = 0.0;
  std::vector<double> residuals;  ///< distance from the centre - radius
};
/// NaN of fewer than four points.
BallFit fit_ball(const std::vector<Vec3>& points);

struct PlaneFit {
  Vec3 center = Vec3::Zero(), normal = Vec3::UnitZ();
  std::vector<double> residuals;  ///< along the normal
};
PlaneFit fit_plane(const std::vector<Vec3>& points);

}  // namespace bin_scenes
