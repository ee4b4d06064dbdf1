/// The sensor model `structured_light`: a fringe projector beside a camera. Both fidelities share geometry, light and
/// the noise of the image sensor. `analytic` computes the noise of the projector column from a formula; `decoded` makes
/// the images and decodes the column from them.
///
/// Let s be the signal of the projector's white at a pixel. The fringe there has the mean A = ambient + s * mean and
/// the amplitude B = s * amplitude * (blur by the pixel's footprint). The noise sigma(A) of the image sensor causes a
/// phase error of sqrt(2 / steps) sigma / B and a column error of period / (2 pi) times that. The measured point is the
/// intersection of the pixel's ray with the plane of that column.
///
/// Where a pixel sees one face in even light, its centre suffices. Near edges of faces, of light and of albedo, the
/// light is summed over cells of a sixteenth of a pixel, weighted by the pixel's area and the blur of the lens
/// (structured_light_strip.hpp).
///
/// Light via other surfaces adds a fringe with another phase, and the sum of both is decoded
/// (indirect_field.hpp). Where this light is brighter than direct light, it may flip bits of the Gray code; there, both
/// fidelities make the images. A second fringe with another period may detect reflected light (ReflectionFilter).
#pragma once

#include "bin_scenes/core/random.hpp"
#include "bin_scenes/raster/view.hpp"
#include "bin_scenes/sensor/filter.hpp"
#include "light/illumination.hpp"
#include "light/indirect_field.hpp"
#include "raster/pixel_rays.hpp"
#include "raster/sight.hpp"
#include "raster/spots.hpp"
#include "sensor/models/fringes.hpp"
#include "sensor/models/imager.hpp"
#include "sensor/models/measurement.hpp"
#include "sensor/models/triangulation.hpp"

#include <memory>
#include <vector>

namespace bin_scenes {

class StructuredLight {
 public:
  struct Setup {
    Lens projector;
    Pose projector_pose;  ///< pose of the projector's optical frame in the bin frame
    StructuredLightSettings settings;
    ImagerSettings imager;
    bool noise = true;
    double near = 0.0, far = 1e9;  ///< m, range of depths that the camera reports
    IndirectField::Setup indirect{};
    bool only_analytic = false;  ///< only analytic() is used: the few images need only coarse indirect light
    ReflectionFilter reflection{};
    bool gray = true;  ///< whether to compute the light of the grey image (Measurement::light)
  };
  /// @param random  random numbers for the samples of indirect light
  StructuredLight(const Scenery& scenery, const View& view, const Surfaces& surfaces, const Setup& setup,
                  const Random& random = Random(0, 0, Stream::sensor));

  Measurement analytic(const Random& random) const;
  Measurement decoded(const Random& random) const;

  /// Returns the predicted standard deviation of the depth of a pixel (m); NaN where no light of the projector falls.
  double depth_sigma(std::size_t pixel) const;

 private:
  using Vec2 = Eigen::Vector2d;
  struct Pixel {
    std::size_t index;  ///< index of the pixel in the image, row-major
    Vec3 ray, normal;   ///< ray through its centre (z = 1), and normal of the face that it sees; camera frame
    double plane;       ///< depth * normal . ray (m), which is the same for all points of the face
  };
  struct Fringe {
    double mean, amplitude;  ///< A and B of the formula above, as shares of the full-well capacity
  };
  struct Received {
    double column = 0.0;
    Fringe fringe{0.0, 0.0};
    bool mixed = false;
    double second_column = 0.0, second_amplitude = 0.0;  ///< column and amplitude of the second fringe, if there is one
  };
  class Strip;
  struct Blend;
  class Normals;

  /// Channels of the indirect light for a projector white of 1; those of the second fringe exist only if there is one.
  /// They are followed by one channel for each image of the fringes.
  enum Channel { white, cosine, sine, second_cosine, second_sine, most_channels };
  int channels() const { return second_ ? most_channels : second_cosine; }
  int images() const { return fringes_.images() + (second_ ? second_->images() : 0); }

  LightSource source() const {
    return {scenery_, setup_.projector, setup_.projector_pose, surfaces_, &sight_, &shades_};
  }
  static std::unique_ptr<const Fringes> second_fringe(const Setup& setup);
  void light_rows(std::size_t first, std::size_t last);
  void add_paths(const std::vector<Path>& paths, const Vec3* steps, float* values) const;
  double gain() const;
  double mean_white() const;
  Pixel pixel(std::size_t column, std::size_t row) const;
  Vec2 slope(const Pixel& pixel) const;
  double diffuse(std::size_t index) const;
  double ambient(std::size_t index) const;
  Fringe fringe(const Pixel& pixel) const;
  double white_light(std::size_t index, const float* indirect) const;
  void blend_white_light(const Blend& blend, std::size_t index, Measurement& out) const;
  double amplitude(const Pixel& pixel, const Fringes& fringes) const;
  double depth_sigma(const Pixel& pixel, const Fringe& fringe) const;
  void add_phasor(const Fringes& fringes, const float* indirect, double& column, double& amplitude) const;
  void add_light(double column, double white, float* images) const;
  void add_even_light(const Path& path, double column, double weight, float* images) const;
  bool saturates(const Fringe& fringe, double column) const;
  double scale_for(const Fringe& fringe, double column) const;
  bool too_dark(const float* indirect) const;
  void add_face(const Pixel& pixel, float* images) const;
  bool expose(const std::vector<float>& images, Random& draw, std::vector<float>& shot, float& scale) const;
  void read(const Strip& strip, const Pixel& pixel, std::vector<float>& images, Random& draw, Measurement& out) const;
  bool blended(const Strip& strip, const Pixel& pixel, Received& got, Measurement& out) const;
  struct Noise;
  void report(const Pixel& pixel, const Received& got, Noise& noise, Measurement& out) const;
  void measure_row(const Strip& strip, std::size_t row, const Random& random, Measurement& out) const;
  template <class Work>
  void in_strips(const Work& work) const;
  void deliver(Measurement& out, const Pixel& pixel, double column) const;
  void take_reflection(Measurement& out, const Pixel& pixel, double column, double second) const;

  const Scenery& scenery_;
  const View& view_;
  const Surfaces& surfaces_;
  Setup setup_;
  Fringes fringes_;
  std::unique_ptr<const Fringes> second_;  ///< null: reflections are not filtered
  Imager imager_;
  Triangulation triangulation_;
  PixelRays rays_;
  ClearSight sight_;
  SpotDrawing spots_, shades_;  ///< draw the surface at given points of the camera's image, and of the projector's
  Mat3 turn_;                   ///< rotation from the camera frame to the bin frame

  // The light on the surface that the centre of each pixel sees, row-major.
  std::vector<Validity> codes_;  ///< validity code: valid, nothing, shadow or outside
  std::vector<double> columns_;  ///< column of the projector's image
  std::vector<double> whites_;   ///< light of the projector's white: Lit::reflected / distance^2 (1/m2)
  std::vector<double> planes_;   ///< Pixel::plane (m)
  std::vector<double> worn_;     ///< share of ambient light that is reflected; empty: no surface has a texture
  std::vector<double> scales_;   ///< exposures / ImagerSettings::exposure, the longest first
  double gain_ = 0.0;            ///< signal of the projector's white = gain * white

  std::unique_ptr<const IndirectField> indirect_;  ///< null: no indirect light
};

}  // namespace bin_scenes
