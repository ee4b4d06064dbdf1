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
    Pose projector_pose;  ///< optical frame in the bin frame
    StereoSettings settings;
    ImagerSettings imager;
    bool noise = true;
    double near = 0.0, far = 1e9;  ///< m, depths that the camera reports
    IndirectField::Setup indirect{};
    StereoPipeline pipeline{};
    bool gray = true;  ///< whether Measurement::light is filled
  };
  /// @param random  of the indirect light's samples
  /// @param view  of the first camera, whose images are rectified: no distortion. With noise, what is measured has
  ///              1 / StereoPipeline::decimation of its width and height
  Stereo(const Scenery& scenery, const View& view, const Surfaces& surfaces, const Setup& setup,
         const Random& random = Random(0, 0, Stream::sensor));

  Measurement analytic(const Random& random) const;
  Measurement decoded(const Random& random) const;

  /// Standard deviation of the depth of a pixel (m), by the analytic form's formula; NaN where no light falls.
  double depth_sigma(std::size_t pixel) const;
  /// Disparity (pixel) of a depth (m), and back.
  double of_disparity(double value) const { return view_.lens.fx * setup_.settings.baseline / value; }

  /// The two images, each as 8 bit: what the matcher is given.
  struct Pair {
    std::vector<std::uint8_t> first, second;
  };
  /// @param scale  exposure / ImagerSettings::exposure
  Pair images(const Random& random, double scale = 1.0) const;

 private:
  std::vector<Lit> lit(const View& view) const;
  std::vector<float> pattern() const;
  std::vector<float> haze(const View& view, const Random& random) const;
  double ambient(const View& view, std::size_t pixel) const;
  std::vector<float> signals(const View& view, const std::vector<Lit>& lit, const std::vector<float>& haze) const;
  std::vector<float> even_light() const;
  /// Of both cameras, without noise.
  struct Signals {
    std::vector<float> first, second;
  };
  Signals signals() const;
  std::vector<std::uint8_t> image(std::vector<float> signals, const Random& random, double scale) const;
  Pair expose(const Signals& signals, const Random& random, double scale) const;
  std::vector<float> matched(const Signals& signals, const Random& random, Measurement& out) const;
  /// The longest exposure of a signal that does not saturate, else the shortest.
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
  Pose second_;  ///< camera, optical frame in the bin frame
  std::vector<Lit> lit_;
  double gain_ = 0.0;
  std::vector<double> scales_;  ///< exposures / ImagerSettings::exposure, the longest first
  std::vector<float> pattern_;  ///< pattern of dots; empty: constant light
  double brightness_ = 1.0;     ///< mean of the pattern
  Random rays_;                 ///< random numbers of indirect light
  std::vector<float> haze_;     ///< indirect light of the first camera's pixels (signal); empty: none
};

/// Returns the disparities (pixels) of the pixels of the first image; NaN means unmatched. They are found by
/// semi-global matching (Hirschmueller 2008, as in OpenCV) with subsequent refinement, or by match_census(). Regions
/// without texture are not matched, and speckles are removed.
std::vector<float> match(const Stereo::Pair& images, int width, int height, const StereoSettings& settings,
                         const StereoPipeline& pipeline, const Imager& imager, int least_disparity);

/// Whether the window around each pixel varies by StereoSettings::min_texture more than noise does.
std::vector<char> textured(const std::vector<std::uint8_t>& image, int width, int height,
                           const StereoSettings& settings, const Imager& imager);

/// Moves each disparity by up to a pixel to where the windows of both images differ least (Lucas, Kanade 1981, "An
/// iterative image registration technique"). The matcher's own parabola errs by up to 0.3 pixel towards whole ones.
void refine(const Stereo::Pair& images, int width, int height, int window, std::vector<float>& disparities);

/// Dots of a projector, blurred as a camera sees them whose pixels are `ratio` of the projector's: row-major, 0 to 1.
std::vector<float> dot_pattern(int width, int height, double dots, DotLayout layout, double ratio);

}  // namespace bin_scenes
