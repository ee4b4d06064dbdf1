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
  /// @param pitch  size of a camera pixel in pixels of the projector
  ExpectedCensus(const StereoSettings& settings, const StereoPipeline& pipeline, double pitch);

  /// @param disparities  in: true disparities (pixels), row-major, NaN where nothing can be matched. Out: the
  ///                     disparities that win, NaN where none wins clearly. At 6 % of the pixels that have no match in
  ///                     their 3 x 3 surroundings, a wrong disparity wins, as in real images.
  void match(int width, int height, const Random& random, std::vector<float>& disparities) const;

  /// Disparity: mean over the window of the surface that the pixel shows. Margin: share of the window that agrees with
  /// it, minus the share that does not; pixels that cannot be matched count for neither.
  struct Match {
    float disparity, margin;
  };
  Match match_of(const std::vector<float>& disparities, int width, int height, int column, int row) const;

  /// Returns a wrong disparity: the smallest one in the window plus `share` (0 to 1) of the range in the window.
  float false_match(const std::vector<float>& disparities, int width, int height, int column, int row,
                    double share) const;

 private:
  int reach_;           ///< pixels, half width of the window
  double least_;        ///< smallest margin with which a disparity wins
  double fluctuation_;  ///< standard deviation of the margin
};

}  // namespace bin_scenes
