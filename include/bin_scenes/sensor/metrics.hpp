/// Quality figures of a sensor as VDI/VDE 2634 part 2 and the data sheets of vendors define them. They are measured on
/// simulated balls and plates with the same sensor models that make the images of scenes. `bin_scenes sensor` prints
/// them.
#pragma once

#include "bin_scenes/scene/request.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace bin_scenes {

/// The standard deviation of depth that the formula of a model predicts in the centre of the image; NaN if nothing is
/// measured.
struct PredictedSigma {
  double distance;   ///< m along the optical axis
  double incidence;  ///< rad, angle between the optical axis and the normal of the surface, which is turned about the
                     ///< camera's x axis
  double albedo;     ///< albedo of a matte surface
  double sigma;      ///< m
};

/// The measured figures. Lengths are in m, and NaN means not measured. Figures with seven values have one for each
/// position in the volume: centre, left, right, up, down, near, far.
struct SensorMetrics {
  std::array<double, 3> distances{};  ///< distance of the nearest, central and farthest plane of the measured volume
  std::vector<PredictedSigma> predicted;
  double ball_radius = 0.0;
  /// Range of the residuals from the fitted ball, without the worst 0.3 % of the points.
  std::array<double, 7> probing_form{};
  std::array<double, 7> probing_size{};  ///< fitted diameter - true diameter
  double sphere_spacing = 0.0;           ///< largest error of the distance between two balls
  /// Range of the residuals from the fitted plane, without the worst 0.3 % of the points.
  std::array<double, 7> flatness{};
  double point_precision = 0.0;  ///< standard deviation of a point over repeated images, median over the points
  double temporal_noise = 0.0;  ///< standard deviation along the optical axis over repeated images, on an albedo of 0.8
  /// Standard deviation of the points from planes that are fitted to 15 x 15 pixels: the median over the planes.
  double local_planarity = 0.0;
  /// Range of the distances of the centres of those planes from one common plane: the error that averaging leaves.
  double global_planarity = 0.0;
  double dimension_trueness = 0.0;  ///< largest error of the distance between two balls / that distance
  std::size_t valid_points = 0;     ///< measured points of the plate in the centre
};

/// Measures the figures of a sensor. The volume extends by 20 % to both sides of the geometric mean of near and far.
/// @param sensor  with or without poses: it is placed at the origin, looking along z, and its projector and laser keep
/// their places relative to it
SensorMetrics measure_sensor(const Sensor& sensor);

}  // namespace bin_scenes
