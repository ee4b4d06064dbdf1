/// The images of a fringe projector: `steps` cosines, each shifted by an equal share of a period, then the bits of a
/// Gray code that counts half periods. The last bit counts halves so that a period is never read off where its number
/// changes (complementary Gray code: Zhang et al. 2012, "Phase unwrapping using complementary Gray code").
#pragma once

#include "bin_scenes/scene/sensor_models.hpp"

#include <cmath>
#include <vector>

namespace bin_scenes {

class Fringes {
 public:
  /// @param width  columns of the projector. Throws an input Error if the Gray code has too few bits for them.
  Fringes(const StructuredLightSettings& settings, int width);
  /// Makes fringes with another period and without a Gray code.
  static Fringes without_code(StructuredLightSettings settings, double period, int width);

  int images() const { return steps_ + bits_; }
  /// Adds to images[i] weight times the light of pattern i at a column (0 dark to 1 white), blurred by pixel and lens.
  void add_light(double column, double weight, float* images) const;
  /// Adds the light of many points at once. The sums are those of single calls, except for rounding.
  void add_light(const std::vector<float>& columns, const std::vector<float>& weights, float* images) const;
  /// Adds light that is constant over `spread` columns around `column`, rounded to the table's 1/32 of a column.
  void add_even_light(double column, double spread, double weight, float* images) const;

  /// Returns the phase per column of the projector (rad).
  double turn() const { return 2.0 * M_PI / period_; }

  struct Phase {
    double periods;     ///< phase as a share of a period, in [0, 1)
    double modulation;  ///< amplitude of the fringe, in the images' unit
    double mean;        ///< mean of the images, in their unit
  };
  Phase phase(const float* images) const;
  /// Returns the first column with this phase; the others follow at distances of one period.
  double column_of(const Phase& phase) const { return phase.periods * period_ - 0.5; }

  struct Reading {
    double column;      ///< column of the projector; NaN if the decoded value is impossible
    double modulation;  ///< amplitude of the fringe, in the images' unit
  };
  /// Returns the values that a device decodes at one pixel from all of its images.
  Reading read(const float* images) const;

  // Returns mean and amplitude of the fringe for a white of 1, without making images.
  double mean() const { return 0.5 * (1.0 + black_); }
  double amplitude() const { return amplitude_; }
  /// Returns the factor by which a pixel reduces the amplitude of a fringe. across, down: number of columns between its
  /// opposite sides in both directions; blur: standard deviation (pixels). The factor includes the area of the pixel
  /// and the blur.
  double seen_through(double across, double down, double blur) const;
  /// Returns the largest cosine of all phase-shifted patterns at this column; that image saturates first.
  double brightest(double column) const;
  /// Returns the standard deviation of the decoded column, given that of the value of one image. The standard deviation
  /// of the phase is sqrt(2 / steps) * image_sigma / modulation.
  double column_sigma(double image_sigma, double modulation) const;
  /// Returns the standard deviation of the measured amplitude, given that of the value of one image.
  double amplitude_sigma(double image_sigma) const;

 private:
  Fringes(const StructuredLightSettings& settings, int width, int bits);
  double row_of(double column) const;
  void add_row(std::size_t row, float weight, float* images) const;

  int steps_, bits_, width_;
  double period_, averaging_, black_, amplitude_;  ///< averaging_: noise of the amplitude / noise of one image
  std::vector<float> table_;                       ///< light of each image, indexed by [sample of a column][image]
  std::vector<float> sine_, cosine_;
};

}  // namespace bin_scenes
