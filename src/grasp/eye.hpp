/// What a camera sees and measures of the contacts of grasps.
#pragma once

#include "bin_scenes/grasp/scene_grasps.hpp"

namespace bin_scenes {

class Eye {
 public:
  /// The image has to outlive it.
  explicit Eye(const RangeImage& image);
  /// Appends the shares of the contact that are seen and measured.
  void look(const Grasp& grasp, SceneGrasp& placed) const;

 private:
  const RangeImage& image_;
  Lens lens_;
  Pose into_camera_;
  bool measures_;  ///< depth and labels are images of the camera, not profiles
};

}  // namespace bin_scenes
