/// Visibility of the contacts of grasps in one image. By the labels and the depth of the image, it determines which
/// share of the contact points of a grasp the camera sees, and which share it has measured.
#pragma once

#include "bin_scenes/grasp/scene_grasps.hpp"

namespace bin_scenes {

class Eye {
 public:
  /// The image must outlive this object.
  explicit Eye(const RangeImage& image);
  /// Appends the shares of the contacts of `grasp` that the camera sees, and has measured, to `visible` and `measured`.
  void look(const Grasp& grasp, SceneGrasp& placed) const;

 private:
  const RangeImage& image_;
  Lens lens_;
  Pose into_camera_;
  bool measures_;  ///< whether depth and labels are images of the camera; false for profiles of a laser line
};

}  // namespace bin_scenes
