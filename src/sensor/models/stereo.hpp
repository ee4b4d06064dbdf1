/// The sensor model `stereo`: two cameras side by side, with a projector of dots. The fidelity `decoded` renders both
/// images and matches them. The fidelity `analytic` reproduces the errors of such a matcher by formulas: its disparity
/// noise is common to a window, and without dots it matches edges only. Light via other surfaces comes from many
/// dots and appears as a haze over the pattern.
#pragma once

#include "bin_scenes/core/random.hpp"
#include "bin_scenes/raster/view.hpp"
#include "bin_scenes/sensor/stereo_pipeline.hpp"
#include "light/illumination.hpp"
#include "light/indirect_field.hpp"
#include "sensor/models/imager.hpp"
#include "sensor/models/measurement.hpp"

#include <vector>

namespace bin_scenes {

class Stereo {
 public:
  struct Setup {
    Lens projector;
    Pose projector_pose;  ///< pose of the projector's optical frame in the bin frame
    StereoSettings settings;
    ImagerSettings imager;
    bool noise = true;
    double near = 0.0, far = 1e9;  ///< m, range of depths that the camera reports
    IndirectField::Setup indirect{};
    StereoPipeline pipeline{};
    bool gray = true;  ///< whether to compute the light of the grey image (Measurement::light)
  };
  /// @param random  random numbers for the samples of indirect light
  /// @param view    view of the first camera, whose images are rectified and undistorted. With noise, the measurement
  ///              has 1 / StereoPipeline::decimation of its width and height
  Stereo(const Scenery& scenery, const View& view, const Surfaces& surfaces, const Setup& setup,
         const Random& random = Random(0, 0, Stream::sensor));

  Measurement analytic(const Random& random) const;
  Measurement decoded(const Random& random) const;

  /// Returns the predicted standard deviation of the depth of a pixel (m); NaN where no light of the projector falls.
  double depth_sigma(std::size_t pixel) const;
  /// Returns the disparity (pixels) of a depth (m), or the depth of a disparity.
  double of_disparity(double value) const { return view_.lens.fx * setup_.settings.baseline / value; }

  /// The images of both cameras that the matcher receives: 8 bits, row-major.
  struct Pair {
    std::vector<std::uint8_t> first, second;
  };
  /// @param scale  exposure time, relative to ImagerSettings::exposure
  Pair images(const Random& random, double scale = 1.0) const;

 private:
  std::vector<Lit> lit(const View& view) const;
  std::vector<float> pattern() const;
  std::vector<float> haze(const View& view, const Random& random) const;
  double ambient(const View& view, std::size_t pixel) const;
  std::vector<float> signals(const View& view, const std::vector<Lit>& lit, const std::vector<float>& haze) const;
  std::vector<float> even_light() const;
  /// Signals of the pixels of both cameras without noise, row-major.
  struct Signals {
    std::vector<float> first, second;
  };
  Signals signals() const;
  std::vector<std::uint8_t> image(std::vector<float> signals, const Random& random, double scale) const;
  Pair expose(const Signals& signals, const Random& random, double scale) const;
  std::vector<float> matched(const Signals& signals, const Random& random, Measurement& out) const;
  /// Returns the largest element of scales_ with which this signal does not saturate, or the smallest one if all do.
  double scale_of(double signal) const;
  void decimate(std::vector<float>& disparities, Measurement& out) const;
  void filter_one(std::vector<float>& disparities) const;
  Measurement deliver(std::vector<float>&& disparities, Measurement&& out) const;
  std::vector<char> surface_texture() const;
  struct Matchable {
    std::vector<float> disparity, sigma;
  };
  std::vector<std::uint8_t> hidden_from_second(std::size_t row) const;
  Matchable matchable(Measurement& out) const;
  double noise_window() const;
  double background(std::size_t pixel) const;
  double disparity_sigma(double signal, double background) const;
  double white(const Lit& lit) const { return gain_ * lit.reflected / (lit.distance * lit.distance); }

  const Scenery& scenery_;
  const View& view_;
  const Surfaces& surfaces_;
  Setup setup_;
  Imager imager_;
  Pose second_;  ///< pose of the second camera's optical frame in the bin frame
  std::vector<Lit> lit_;
  double gain_ = 0.0;
  std::vector<double> scales_;  ///< exposures / ImagerSettings::exposure, the longest first
  std::vector<float> pattern_;  ///< light of the dot pattern, row-major; empty: constant light
  double brightness_ = 1.0;     ///< mean of the dot pattern
  Random rays_;                 ///< random numbers for the samples of indirect light
  std::vector<float> haze_;     ///< indirect light of the first camera's pixels (signal); empty: none
};

/// Returns the disparities (pixels) of the pixels of the first image; NaN means unmatched. They are found by
/// semi-global matching (Hirschmueller 2008, as in OpenCV) with subsequent refinement, or by match_census(). Regions
/// without texture are not matched, and speckles are removed.
std::vector<float> match(const Stereo::Pair& images, int width, int height, const StereoSettings& settings,
                         const StereoPipeline& pipeline, const Imager& imager, int least_disparity);

/// Returns for each pixel whether its window varies by StereoSettings::min_texture more than noise does.
std::vector<char> textured(const std::vector<std::uint8_t>& image, int width, int height,
                           const StereoSettings& settings, const Imager& imager);

/// Moves each disparity by up to one pixel to where the windows of both images differ least (Lucas, Kanade 1981, "An
/// iterative image registration technique"). The matcher's own parabola errs by up to 0.3 pixel towards integers.
void refine(const Stereo::Pair& images, int width, int height, int window, std::vector<float>& disparities);

/// Returns the dots of a projector, row-major, 0 to 1, as blurred by camera pixels of `ratio` projector pixels each.
std::vector<float> dot_pattern(int width, int height, double dots, DotLayout layout, double ratio);

}  // namespace bin_scenes
