/// The projection of a camera or projector: a pinhole with skew, and the five distortion coefficients of the plumb_bob
/// model of ROS. It maps points to pixels and pixels to rays, and knows nothing about poses.
#pragma once

#include "bin_scenes/core/types.hpp"

#include <array>
#include <optional>

namespace bin_scenes {

struct Sensor;
struct Projector;

/// A lens in its optical frame: x right, y down, z forward. Integer coordinates are pixel centres, as in CameraInfo.
/// Let x' = x/z and y' = y/z, and let x" and y" be their distorted values (Brown 1971, "Close-range camera
/// calibration"). A point is projected to column = fx x" + skew y" + cx and row = fy y" + cy.
struct Lens {
  int width = 0, height = 0;              ///< pixels
  double fx = 0.0, skew = 0.0, cx = 0.0;  ///< pixels; first row of K
  double fy = 0.0, cy = 0.0;              ///< pixels; second row of K
  std::array<double, 5> distortion{};     ///< k1 k2 p1 p2 k3, as in CameraInfo's D

  /// Returns the direction with z = 1 (optical frame) that is projected to (column, row); the distortion is removed to
  /// 1e-12. The result is NaN if no direction is projected there, as can happen near the border with strong distortion.
  Vec3 ray(double column, double row) const;
  /// Returns (column, row) of a point in the optical frame (m), whether inside the image or not. Returns none if z <=
  /// 0, and where the distortion would fold the image back.
  std::optional<Eigen::Vector2d> project(const Vec3& point) const;
  /// Whether a pixel is within the image, up to the outer edge of the outermost pixels.
  bool inside(const Eigen::Vector2d& pixel) const;
  bool distorts() const;

  /// Returns a lens with square pixels, the principal point in the centre, and no distortion. @param fov  horizontal
  /// field of view (rad)
  static Lens from_fov(int width, int height, double fov);
};

Lens lens_of(const Sensor& sensor);  ///< of the camera; K must be filled in
Lens lens_of(const Projector& projector);

}  // namespace bin_scenes
