/// Runs all sensors of a request on one scene after the other.
#pragma once

#include "bin_scenes/part/loaded_request.hpp"
#include "bin_scenes/scene/scene.hpp"
#include "bin_scenes/sensor/range_image.hpp"

#include <memory>
#include <vector>

namespace bin_scenes {

class SceneryCache;

/// Keeps between scenes what is expensive to make: the search trees of models, while the models live.
class SensorRig {
 public:
  SensorRig();
  ~SensorRig();
  /// Returns one image for each of `scene.sensors`, which must be resolved(). Sets the visible fractions of the parts,
  /// and counts views and silhouettes in the profile of the report. May be called for several scenes at the same time
  /// in several threads. The same scene gives the same bits each time. Parts that were not poured, or whose pose is not
  /// finite, are left out.
  std::vector<RangeImage> render(Scene& scene, const LoadedRequest& loaded);
  /// The same for some sensors: makes the images of those that are wanted, unless they are there already. `wanted` and
  /// `images` have one entry a sensor; an image that has not been made is RangeImage().
  void render(Scene& scene, const LoadedRequest& loaded, const std::vector<bool>& wanted,
              std::vector<RangeImage>& images);

 private:
  std::unique_ptr<SceneryCache> cache_;
};

}  // namespace bin_scenes
