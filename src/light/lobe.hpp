/// Random directions from which a surface reflects light towards the eye. Their density is proportional to the share of
/// light that is reflected from each direction (importance sampling).
#pragma once

#include "bin_scenes/scene/request.hpp"
#include "light/facets.hpp"

namespace bin_scenes {

class Lobe {
 public:
  /// @param normal, to_eye  unit vectors on the same side of the surface
  Lobe(const Surface& surface, const Vec3& normal, const Vec3& to_eye);

  struct Sample {
    Vec3 direction;      ///< unit vector, away from the surface; points below it if `factor` is 0
    double factor;       ///< light reflected to the eye / radiance from this direction, if this is the only sample
    double density;      ///< probability density of the direction per solid angle (1/sr)
    double matte = 0.0;  ///< part of `factor` that is scattered light; the remainder is mirrored
  };
  /// Draws a direction. @param u, v  random numbers in [0, 1)
  Sample at(double u, double v) const;
  /// Returns the probability density with which at() draws a direction (1/sr).
  double density_of(const Vec3& direction) const { return density(frame_.transpose() * direction); }

 private:
  Vec3 matte(double u, double v) const;
  Vec3 mirrored(double u, double v) const;
  double density(const Vec3& local) const;

  Surface surface_;
  Mat3 frame_;  ///< rotation from local axes to the bin frame; local z is the normal
  Vec3 eye_;    ///< unit direction to the eye in local axes
  Widths widths_;
  double share_;  ///< share of the samples that are drawn from the mirrored lobe
};

}  // namespace bin_scenes
