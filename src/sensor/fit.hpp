/// Fits balls and planes to points by least squares, for the quality figures of sensors (sensor/metrics.hpp). The
/// residuals are returned as well, because the quality figures are computed from them.
#pragma once

#include "bin_scenes/core/types.hpp"

#include <vector>

namespace bin_scenes {

struct BallFit {
  Vec3 center = Vec3::Zero();
  double radius = 0.0;
  std::vector<double> residuals;  ///< for each point: its distance from the centre, minus the radius (m)
};
/// Fits a ball to the points. All values are NaN if there are fewer than four points.
BallFit fit_ball(const std::vector<Vec3>& points);

struct PlaneFit {
  Vec3 center = Vec3::Zero(), normal = Vec3::UnitZ();
  std::vector<double> residuals;  ///< for each point: its signed distance from the plane (m)
};
PlaneFit fit_plane(const std::vector<Vec3>& points);

}  // namespace bin_scenes
