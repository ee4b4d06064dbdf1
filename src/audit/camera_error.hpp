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
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();  ///< px, error of the principal point
  Eigen::Vector2d scale = Eigen::Vector2d::Zero();  ///< relative error of the focal lengths
  double radial = 0.0;                              ///< radial distortion k1 that is still in the images

  /// Returns the displacement (px) of a point that the stated camera matrix `k` projects to `at`.
  Eigen::Vector2d at(const Eigen::Vector2d& at, const std::array<double, 9>& k) const;
  /// Returns the largest displacement (px) at the corners and the centre of an image.
  double largest(int width, int height, const std::array<double, 9>& k) const;
  std::array<double, 9> corrected(std::array<double, 9> k) const;  ///< returns the camera matrix without the error
};

/// The shift of a mask against the silhouette of its part, and the position of that silhouette.
struct ShiftSample {
  Eigen::Vector2d at, shift;  ///< px: position of the silhouette; shift of the mask
};

/// Fits the error by reweighted least squares with Tukey's biweight, starting from the median of all shifts, so that up
/// to a third of the samples may be wrong by any amount. Scale needs 10 samples and radial distortion 20; both are 0
/// unless they explain the shifts much better. Returns none for fewer than 4 samples.
std::optional<CameraError> fit_camera(const std::vector<ShiftSample>& samples, const std::array<double, 9>& k);

/// Difference between the measured depth of a part and the depth of its model.
struct DepthSample {
  double error;        ///< mm, measured depth minus depth of the model
  double depth;        ///< m, depth of the model
  double obliqueness;  ///< distance from the camera / depth - 1
};

struct DepthError {
  double offset = 0.0;    ///< mm, constant error of all depths
  double scale = 0.0;     ///< relative error of the depth scale
  double distance = 0.0;  ///< 1: the image holds distances from the camera instead of depths along its axis
  double of(const DepthSample& sample) const {
    return offset + 1e3 * sample.depth * (scale + distance * sample.obliqueness);
  }
};
std::optional<DepthError> fit_depth(const std::vector<DepthSample>& samples);

double median_of(std::vector<double> values);  ///< returns the lower median; 0 if there are no values

}  // namespace bin_scenes
