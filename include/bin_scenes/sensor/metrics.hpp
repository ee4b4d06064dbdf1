/// Quality figures of a sensor, as VDI/VDE 2634 part 2 and vendors' data sheets define them, measured on simulated
/// balls and plates with the sensor models that scenes use.
#pragma once

#include "bin_scenes/scene/request.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace bin_scenes {

/// Standard deviation of depth by the model's formula, in the centre of the image; NaN where it measures nothing.
struct PredictedSigma {
  double distance;   ///< m along the optical axis
  double incidence;  ///< rad, between the optical axis and the surface's normal, turned about the camera's x
  double albedo;     ///< of a matte surface
  double sigma;      ///< m
};

/// Lengths in m; NaN of what is not measured. Where a figure has seven positions, they are the centre of the volume,
/// left, right, up, down, near, far.
struct SensorMetrics {
  std::array<double, 3> distances{};  ///< nearest, centre and farthest plane of the volume measured in
  std::vector<PredictedSigma> predicted;
  double ball_radius = 0.0;
  std::array<double, 7> probing_form{};  ///< range of residuals to the ball fitted, 0.3 % of the points left out
  std::array<double, 7> probing_size{};  ///< diameter fitted - true
  double sphere_spacing = 0.0;           ///< largest error of a distance between two balls
  std::array<double, 7> flatness{};      ///< range of residuals to the plane fitted, 0.3 % of the points left out
  double point_precision = 0.0;          ///< standard deviation of a point over repeated images, median over points
  double temporal_noise = 0.0;           ///< the same along the optical axis, on an albedo of 0.8
  double local_planarity = 0.0;          ///< standard deviation of points to planes fitted to 15 x 15 pixels, median
  double global_planarity =
      0.0;  ///< range of the centres of those planes about one plane: the error that averaging leaves
  double dimension_trueness = 0.0;  ///< largest error of a distance between two balls / the distance
  std::size_t valid_points = 0;     ///< of the plate in the centre
};

/// @param sensor  with or without poses: it is put at the origin, looking along z, and projector and laser keep their
///                places beside it. The volume lies around the geometric mean of near and far, within 20 % of it.
SensorMetrics measure_sensor(const Sensor& sensor);

}  // namespace bin_scenes
