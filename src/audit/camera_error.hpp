/// Estimates the error of the camera matrix and of the depth scale that a data set states. The input is the
/// disagreement of many parts between their labels and their models: shifts of masks against silhouettes, and
/// differences of depth. The estimates are robust against wrong labels of single parts. They are reported; the data are
/// not corrected.
#pragma once

#include <Eigen/Core>

#include <array>
#include <optional>
#include <vector>

namespace bin_scenes {

/// Displacement (pixels) of the true images from where the stated camera matrix projects them.
struct CameraError {
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();  ///< px, of the principal point
  Eigen::Vector2d scale = Eigen::Vector2d::Zero();  ///< relative error of the focal lengths
  double radial = 0.0;                              ///< k1 of a lens whose distortion the images still have

  /// px, of a point that the stated K images at `at`.
  Eigen::Vector2d at(const Eigen::Vector2d& at, const std::array<double, 9>& k) const;
  /// px, the largest of an image's corners and centre.
  double largest(int width, int height, const std::array<double, 9>& k) const;
  std::array<double, 9> corrected(std::array<double, 9> k) const;
};

/// The shift of a mask against the silhouette of its part, and the position of that silhouette.
struct ShiftSample {
  Eigen::Vector2d at, shift;  ///< px
};

/// Fits the error by reweighted least squares with Tukey's biweight, starting from the median of all shifts, so that up
/// to a third of the samples may be wrong by any amount. Scale needs 10 samples and radial distortion 20; both are 0
/// unless they explain the shifts much better. Returns none for fewer than 4 samples.
std::optional<CameraError> fit_camera(const std::vector<ShiftSample>& samples, const std::array<double, 9>& k);

/// Depth of a part.
struct DepthSample {
  double error;        ///< mm, measured less model's
  double depth;        ///< m
  double obliqueness;  ///< distance / depth - 1
};

struct DepthError {
  double offset = 0.0;    ///< mm
  double scale = 0.0;     ///< relative
  double distance = 0.0;  ///< 1: the image holds distances from the camera instead of depths along its axis
  double of(const DepthSample& sample) const {
    return offset + 1e3 * sample.depth * (scale + distance * sample.obliqueness);
  }
};
std::optional<DepthError> fit_depth(const std::vector<DepthSample>& samples);

double median_of(std::vector<double> values);  ///< the lower one of an even number; 0 of none

}  // namespace bin_scenes
