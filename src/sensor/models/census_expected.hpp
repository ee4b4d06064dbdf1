/// Predicts by formula what match_census() would return for a surface: disparities blended over the window at small
/// depth steps, gaps at large steps, holes where the window contains few dots by chance, and single false matches
/// inside gaps. The analytic fidelity of `stereo` uses it.
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
  ///                     and NaN where none beats the others by enough. At 6 % of such pixels that have no match among
  ///                     their eight neighbours, a wrong disparity wins, as it does at few pixels of real images.
  void match(int width, int height, const Random& random, std::vector<float>& disparities) const;

  /// Of a pixel: the mean disparity of the surface that it belongs to, over the window, and the share of the window
  /// that agrees with it less the share that does not; pixels that cannot be matched count for neither.
  struct Match {
    float disparity, margin;
  };
  Match match_of(const std::vector<float>& disparities, int width, int height, int column, int row) const;

  /// A wrong disparity: the least one of the window plus `share` (0 to 1) of the range of disparities in the window.
  float false_match(const std::vector<float>& disparities, int width, int height, int column, int row,
                    double share) const;

 private:
  int reach_;           ///< pixel, of the window to each side
  double least_;        ///< margin
  double fluctuation_;  ///< standard deviation of the margin
};

}  // namespace bin_scenes
