/// Predicts by formula what match_census() would return for a surface: disparities blended over the window at small
/// depth steps, gaps at large steps, and holes where the window contains few dots by chance. The analytic fidelity of
/// `stereo` uses it.
#pragma once

#include "bin_scenes/core/random.hpp"
#include "bin_scenes/scene/sensor_models.hpp"
#include "bin_scenes/sensor/stereo_pipeline.hpp"

#include <vector>

namespace bin_scenes {

class ExpectedCensus {
 public:
  /// @param pitch  pixels of the projector per pixel of the camera
  ExpectedCensus(const StereoSettings& settings, const StereoPipeline& pipeline, double pitch);

  /// @param disparities  in: the true ones (pixel), row-major, NaN where nothing can be matched. Out: those that win,
  /// NaN
  ///                     where none beats the others by enough
  void match(int width, int height, const Random& random, std::vector<float>& disparities) const;

  /// Of a pixel: the mean disparity of the surface that it belongs to, over the window, and the share of the window
  /// that agrees with it less the share that does not; pixels that cannot be matched count for neither.
  struct Match {
    float disparity, margin;
  };
  Match match_of(const std::vector<float>& disparities, int width, int height, int column, int row) const;

 private:
  int reach_;           ///< pixel, of the window to each side
  double least_;        ///< margin
  double fluctuation_;  ///< standard deviation of the margin
};

}  // namespace bin_scenes
