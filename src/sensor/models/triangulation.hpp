/// Depth from a projector column: the camera's ray meets the surface that the column lights, a plane unless the
/// projector's lens is distorted.
#pragma once

#include "bin_scenes/core/types.hpp"
#include "bin_scenes/sensor/lens.hpp"

namespace bin_scenes {

class Triangulation {
 public:
  /// @param projector_in_camera  the projector's optical frame in the camera's
  Triangulation(const Lens& projector, const Pose& projector_in_camera);

  /// Depth z (m) on the camera's ray (z = 1) of what lies in a column; NaN where ray and column do not meet in front of
  /// both.
  double depth(const Vec3& ray, double column) const;
  /// |d depth / d column| (m) at a depth.
  double depth_per_column(const Vec3& ray, double depth) const;
  /// Columns passed on a short way from a point (camera frame), distortion left out.
  double columns_along(const Vec3& point, const Vec3& way) const;

 private:
  Lens projector_;
  bool distorted_;
  Mat3 turn_;    ///< camera to projector
  Vec3 origin_;  ///< the camera in the projector's frame
};

}  // namespace bin_scenes
