/// The processing between the two images of a stereo camera and its depth, and the number format of depth of any range
/// camera. The structs are stored in Sensor::settings beside StereoSettings (scene/sensor_models.hpp). The meaning,
/// unit and range of each value are in the tables of keys (docs/use/request.md).
#pragma once

namespace bin_scenes {

/// How the two images of a stereo camera are compared.
enum class StereoMatcher {
  semi_global,  ///< intensities along several paths (Hirschmueller 2008), as in OpenCV
  census        ///< census signatures, summed over a window
};

/// Edge-preserving recursive smoothing of disparities (Gastal, Oliveira 2011, "Domain transform for edge-aware image
/// and video processing"), which is part of the post-processing of stereo cameras.
struct SpatialFilter {
  double alpha = 0.5;
  double delta = 0.625;
  int iterations = 0;
};

/// The keys of `stereo` that are not in StereoSettings.
struct StereoPipeline {
  StereoMatcher matcher = StereoMatcher::semi_global;
  int census = 7;
  double second_peak = 0.025;
  double disparity_step = 1.0 / 16.0;
  SpatialFilter spatial;
};

/// The number format of depth.
struct DepthFormat {
  double unit = 0.0;  ///< m; 0 = not rounded
};

}  // namespace bin_scenes
