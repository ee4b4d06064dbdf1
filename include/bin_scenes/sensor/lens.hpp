/// Projection of a camera or projector: pinhole with skew and the five distortion coefficients of plumb_bob.
#pragma once

#include "bin_scenes/core/types.hpp"

#include <array>
#include <optional>

namespace bin_scenes {

/// Optical frame: x right, y down, z forward. Integer coordinates are pixel centres, as in CameraInfo. With x' = x/z,
/// y' = y/z, distorted to x", y" (Brown 1971, "Close-range camera calibration"), a point falls on
/// column = fx x" + skew y" + cx, row = fy y" + cy.
struct Lens {
  int width = 0, height = 0;              ///< pixels
  double fx = 0.0, skew = 0.0, cx = 0.0;  ///< pixels; first row of K
  double fy = 0.0, cy = 0.0;              ///< pixels; second row of K
  std::array<double, 5> distortion{};     ///< k1 k2 p1 p2 k3, as in CameraInfo's D

  /// Direction with z = 1 (optical frame) that the lens images on (column, row); the distortion is removed to 1e-12.
  /// NaN where no direction falls there: the distortion of a strong lens has an end.
  Vec3 ray(double column, double row) const;
  /// (column, row) of a point of the optical frame, inside the image or not; none at z <= 0 and where the distortion
  /// would fold back.
  std::optional<Eigen::Vector2d> project(const Vec3& point) const;
  bool inside(const Eigen::Vector2d& pixel) const;  ///< within the image, up to the outer edge of the outer pixels
  bool distorts() const;

  /// Square pixels, principal point in the centre, no distortion. @param fov horizontal field of view (rad)
  static Lens from_fov(int width, int height, double fov);
};

}  // namespace bin_scenes
