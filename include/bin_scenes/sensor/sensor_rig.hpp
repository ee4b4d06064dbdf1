/// Runs all sensors of a request on one scene after the other: it places the meshes, casts the views, applies the
/// sensor models and counts visible pixels. The images are returned, not written.
#pragma once

#include "bin_scenes/part/loaded_request.hpp"
#include "bin_scenes/scene/scene.hpp"
#include "bin_scenes/sensor/range_image.hpp"

#include <memory>
#include <vector>

namespace bin_scenes {

class SceneryCache;

/// The sensors of a job. Between scenes, a rig keeps the search trees of models, which are expensive to build.
class SensorRig {
 public:
  SensorRig();
  ~SensorRig();
  /// Returns one image for each of `scene.sensors`, which must be resolved(). Sets the visible fractions of the parts,
  /// and counts views and silhouettes in the profile of the report. It may be called for several scenes at the same
  /// time in several threads. The same scene gives the same bits each time. Parts that were not poured, or whose pose
  /// is not finite, are left out.
  /// @param gray  whether grey images are made (RangeImage::gray), which costs up to a fifth of the time
  std::vector<RangeImage> render(Scene& scene, const LoadedRequest& loaded, bool gray = true);
  /// The same for some of the sensors: makes the images that are wanted, unless they exist already. `wanted` and
  /// `images` have one entry for each sensor; an image that has not been made is RangeImage().
  void render(Scene& scene, const LoadedRequest& loaded, const std::vector<bool>& wanted,
              std::vector<RangeImage>& images, bool gray);

 private:
  std::unique_ptr<SceneryCache> cache_;
};

}  // namespace bin_scenes
