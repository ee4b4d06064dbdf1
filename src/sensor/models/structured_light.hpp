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
  struct Fringe {
    double mean, amplitude;  ///< A and B
  };
  struct Samples;  ///< the sub-rays of a row

  SeenPoint seen(std::size_t pixel) const;
  Fringe fringe(std::size_t pixel) const;
  double footprint(std::size_t pixel) const;
  bool near_edge(std::size_t pixel) const;
  void sample(const std::vector<std::size_t>& pixels, Samples& samples) const;
  void deliver(Measurement& out, std::size_t pixel, double column) const;
  double mixed_column(const Lit* lit) const;

  const Scenery& scenery_;
  const View& view_;
  const Surfaces& surfaces_;
  Setup setup_;
  Fringes fringes_;
  Imager imager_;
  Triangulation triangulation_;
  Mat3 turn_;               ///< of the camera
  std::vector<Vec3> rays_;  ///< of every pixel's centre, camera frame, z = 1
  std::vector<Lit> lit_;    ///< of every pixel's centre
  double gain_ = 0.0;       ///< signal of the projector's white = gain * reflected / distance^2
};

}  // namespace bin_scenes
