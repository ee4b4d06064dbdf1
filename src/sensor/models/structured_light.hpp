/// A fringe projector beside a camera. Both fidelities share geometry, light and the chip's noise: `analytic` takes the
/// noise of the column from its formula, `decoded` makes the images and reads the column from them.
///
/// With s the signal of the projector's white at a pixel, the fringe there has mean A = ambient + s * mean and
/// amplitude B = s * amplitude * (blur by the pixel's footprint). The chip's noise sigma(A) makes the phase err by
/// sqrt(2 / steps) sigma / B and the column by period / 2 pi of that; the ray meets the plane of that column.
#pragma once

#include "bin_scenes/core/random.hpp"
#include "bin_scenes/sensor/view.hpp"
#include "sensor/models/fringes.hpp"
#include "sensor/models/illumination.hpp"
#include "sensor/models/imager.hpp"
#include "sensor/models/measurement.hpp"
#include "sensor/models/triangulation.hpp"

#include <vector>

namespace bin_scenes {

class StructuredLight {
 public:
  struct Setup {
    Lens projector;
    Pose projector_pose;  ///< optical frame in the bin frame
    StructuredLightSettings settings;
    ImagerSettings imager;
    bool noise = true;
    double near = 0.0, far = 1e9;  ///< m, depths that the camera reports
  };
  StructuredLight(const Scenery& scenery, const View& view, const Surfaces& surfaces, const Setup& setup);

  Measurement analytic(const Random& random) const;
  Measurement decoded(const Random& random) const;

  /// Standard deviation of the depth of a pixel (m), by the formula; NaN where no light falls.
  double depth_sigma(std::size_t pixel) const;

 private:
  /// A pixel of the camera and the light that falls on what its centre sees.
  struct Pixel {
    std::size_t index;  ///< in the image, row-major
    Vec3 ray;           ///< through its centre, camera frame, z = 1
    Lit lit;
  };
  struct Fringe {
    double mean, amplitude;  ///< A and B, shares of the full well
  };
  struct Samples;  ///< four rays through each of several pixels
  struct Reading {
    double column;  ///< of the projector, without noise
    Fringe fringe;
  };

  std::vector<Pixel> lit(std::vector<std::size_t> indices) const;
  std::vector<Pixel> lit_row(std::size_t row) const;
  double gain() const;
  SeenPoint seen(std::size_t index, const Vec3& ray) const;
  double ambient(const Pixel& pixel) const;
  Fringe fringe(const Pixel& pixel) const;
  double depth_sigma(const Pixel& pixel, const Fringe& fringe) const;
  double footprint(const Pixel& pixel) const;
  bool is_uneven(const Pixel& pixel, const Fringe& fringe) const;
  double step_beside(const Pixel& pixel) const;
  void sample(const std::vector<Pixel>& pixels, Samples& samples) const;
  Reading summed(const Pixel& pixel, const Lit* samples) const;
  void deliver(Measurement& out, const Pixel& pixel, double column) const;

  const Scenery& scenery_;
  const View& view_;
  const Surfaces& surfaces_;
  Setup setup_;
  Fringes fringes_;
  Imager imager_;
  Triangulation triangulation_;
  Mat3 turn_;          ///< of the camera
  double gain_ = 0.0;  ///< signal of the projector's white = gain * reflected / distance^2
};

}  // namespace bin_scenes
