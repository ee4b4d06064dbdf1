/// Computes depth from a projector column: the intersection of the camera's ray with the surface that the column
/// lights. This surface is a plane unless the lens of the projector is distorted.
#pragma once

#include "bin_scenes/core/types.hpp"
#include "bin_scenes/raster/lens.hpp"

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
  /// Columns passed on a face with that normal from the point at a depth to the next pixel of the camera, across and
  /// down; distortion left out.
  Eigen::Vector2d slope(const Vec3& ray, double depth, const Vec3& normal, const Lens& camera) const;

 private:
  /// Column = share / depth in the projector's frame, of a point depth * ray: what both are for a depth of 1.
  struct Along {
    double share, depth;
  };
  Along along(const Vec3& ray) const { return {share_.dot(ray), ahead_.dot(ray)}; }

  Lens projector_;
  bool distorted_;
  Mat3 turn_;                         ///< camera to projector
  Vec3 origin_;                       ///< the camera in the projector's frame
  Vec3 share_, ahead_;                ///< coefficients of a direction in the camera's frame
  double share_there_, ahead_there_;  ///< values at the camera itself
};

}  // namespace bin_scenes
