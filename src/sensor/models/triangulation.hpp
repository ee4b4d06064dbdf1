/// Computes depth from a projector column: the intersection of the camera's ray with the surface that the column
/// lights. This surface is a plane unless the lens of the projector is distorted.
#pragma once

#include "bin_scenes/core/types.hpp"
#include "bin_scenes/raster/lens.hpp"

namespace bin_scenes {

class Triangulation {
 public:
  /// @param projector_in_camera  pose of the projector's optical frame in the camera's optical frame
  Triangulation(const Lens& projector, const Pose& projector_in_camera);

  /// Returns the depth z (m) at which a ray of the camera (z = 1) meets the surface that a projector column lights; NaN
  /// if they do not meet in front of camera and projector.
  double depth(const Vec3& ray, double column) const;
  /// Returns by how much the depth on a ray changes per projector column, |d depth / d column| (m), at a depth (m).
  double depth_per_column(const Vec3& ray, double depth) const;
  /// Returns by how many projector columns the next camera pixel to the right, and the next one below, differ from this
  /// pixel, on a face with that normal through the point at `depth` (m). Lens distortion is neglected.
  Eigen::Vector2d slope(const Vec3& ray, double depth, const Vec3& normal, const Lens& camera) const;

 private:
  /// A projected column is a quotient share / depth. These are the changes of both per 1 m of camera depth on a ray.
  struct Along {
    double share, depth;
  };
  Along along(const Vec3& ray) const { return {share_.dot(ray), ahead_.dot(ray)}; }

  Lens projector_;
  bool distorted_;
  Mat3 turn_;           ///< rotation from the camera frame to the projector frame
  Vec3 origin_;         ///< position of the camera in the projector's frame (m)
  Vec3 share_, ahead_;  ///< their dot products with a ray (camera frame) are Along::share and Along::depth
  double share_there_, ahead_there_;  ///< share and depth of the camera's own position
};

}  // namespace bin_scenes
