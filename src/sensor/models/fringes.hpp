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
  /// Of another period and without a Gray code.
  static Fringes without_code(StructuredLightSettings settings, double period, int width);

  int images() const { return steps_ + bits_; }
  /// Adds weight * light (0 dark, 1 the projector's white) of every image at a column, blurred by pixel and lens.
  void add_light(double column, double weight, float* images) const;
  /// The same of light that is even over `spread` columns.
  void add_even_light(double column, double spread, double weight, float* images) const;

  /// Radians a column.
  double turn() const { return 2.0 * M_PI / period_; }

  struct Phase {
    double periods;     ///< in [0, 1)
    double modulation;  ///< amplitude of the fringe, in the images' unit
    double mean;
  };
  Phase phase(const float* images) const;
  /// One of the columns of a phase.
  double column_of(const Phase& phase) const { return phase.periods * period_ - 0.5; }

  struct Reading {
    double column;      ///< of the projector; NaN if the code makes no sense
    double modulation;  ///< amplitude of the fringe, in the images' unit
  };
  /// The values that a device reads at one pixel of all images.
  Reading read(const float* images) const;

  // The same without images, for a white of 1: mean and amplitude of the fringe.
  double mean() const { return 0.5 * (1.0 + black_); }
  double amplitude() const { return amplitude_; }
  /// By which factor a pixel weakens the amplitude that covers so many columns from one side to the other, across and
  /// down: its box's and that of a blur (pixel, standard deviation).
  double seen_through(double across, double down, double blur) const;
  /// Largest value of cos over the images at this column: what saturates first.
  double brightest(double column) const;
  /// Standard deviation of the column for that of an image's value: sqrt(2 / steps) * sigma / modulation is the
  /// phase's.
  double column_sigma(double image_sigma, double modulation) const;
  /// The same for the amplitude read.
  double amplitude_sigma(double image_sigma) const;

 private:
  Fringes(const StructuredLightSettings& settings, int width, int bits);

  int steps_, bits_, width_;
  double period_, averaging_, black_, amplitude_;  ///< averaging: of the amplitude's noise by the steps
  std::vector<float> table_;                       ///< [sample of a column][image]
  std::vector<float> sine_, cosine_;
};

}  // namespace bin_scenes
