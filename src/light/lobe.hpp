/// Random directions from which a surface reflects light towards the eye. Their density is proportional to the share of
/// light that is reflected from each direction (importance sampling).
#pragma once

#include "bin_scenes/scene/request.hpp"
#include "light/facets.hpp"

namespace bin_scenes {

class Lobe {
 public:
  /// @param normal, to_eye  unit, on one side of the surface
  Lobe(const Surface& surface, const Vec3& normal, const Vec3& to_eye);

  struct Sample {
    Vec3 direction;  ///< unit, away from the surface; below it where factor is 0
    double factor;   ///< light sent to the eye / light that comes from there, for one sample of the whole hemisphere
    double density;  ///< per solid angle (1/sr)
    double matte = 0.0;  ///< part of factor that is scattered, not mirrored
  };
  /// @param u, v  [0, 1), even in the square
  Sample at(double u, double v) const;
  /// Returns the probability density with which at() draws a direction (1/sr).
  double density_of(const Vec3& direction) const { return density(frame_.transpose() * direction); }

 private:
  Vec3 matte(double u, double v) const;
  Vec3 mirrored(double u, double v) const;
  double density(const Vec3& local) const;

  Surface surface_;
  Mat3 frame_;  ///< local to world, z is the normal
  Vec3 eye_;    ///< local
  Widths widths_;
  double share_;  ///< share of the samples that are drawn from the mirrored lobe
};

}  // namespace bin_scenes
