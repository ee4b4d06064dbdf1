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

/// Of how many of the last images a pixel must have been measured in for its last value to replace a missing one.
enum class Persistence {
  off,
  eight_of_eight,
  two_of_three,
  two_of_four,
  two_of_eight,
  one_of_two,
  one_of_five,
  one_of_eight,
  always
};

/// Exponential average of the disparities of successive images of the scene at rest; names and defaults are those of
/// librealsense (doc/post-processing-filters.md). It is applied to `frames` images, and the last result is delivered.
struct TemporalFilter {
  int frames = 1;
  double alpha = 0.4;
  double delta = 0.625;
  Persistence persistence = Persistence::two_of_four;
};

/// From where a missing pixel takes its depth: among the neighbours to the left, above and below.
enum class HoleFilling { off, left, farthest, nearest };

/// How the dots of the projector are distributed.
enum class DotLayout {
  random,  ///< each of the projector's pixels is a dot with the same probability
  spread   ///< one dot at a random place in each square of a grid, so that no region is without dots
};

/// Further settings of stereo cameras, which the keys of `stereo` set in addition to StereoSettings.
struct StereoPipeline {
  DotLayout layout = DotLayout::random;
  StereoMatcher matcher = StereoMatcher::semi_global;
  int census = 7;
  double second_peak = 0.025;
  double disparity_step = 1.0 / 16.0;
  int decimation = 1;
  SpatialFilter spatial;
  TemporalFilter temporal;
  HoleFilling hole_filling = HoleFilling::off;
};

/// The number format of depth.
struct DepthFormat {
  double unit = 0.0;  ///< depths are rounded to multiples of this length (m); 0: not rounded
};

}  // namespace bin_scenes
