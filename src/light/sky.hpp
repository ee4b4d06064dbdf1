/// The sky as an equirectangular picture, from which directions are drawn in proportion to their radiance (Pharr,
/// Jakob, Humphreys, "Physically based rendering", 4th edition, 12.5): first a pixel by row and column, then a uniform
/// direction within its solid angle. The radiance is constant within a pixel, so that the probability of a direction is
/// exact.
#pragma once

#include "bin_scenes/core/types.hpp"

#include <memory>
#include <string>
#include <vector>

namespace bin_scenes {

/// An equirectangular picture of all directions; its first row is at the zenith.
struct Panorama {
  int width = 0, height = 0;
  std::vector<Eigen::Array3f> radiance;  ///< red, green and blue of each pixel, row-major
};
/// Reads a Radiance file (.hdr).
std::shared_ptr<const Panorama> read_panorama(const std::string& path);

class Sky {
 public:
  /// @param turn  rotation about the vertical (rad); at 0, the centre of the picture is in the direction of x
  Sky(std::shared_ptr<const Panorama> picture, const Eigen::Array3d& scale, double turn);
  Eigen::Array3d at(const Vec3& direction) const;

  struct Sample {
    Vec3 direction;
    double density;  ///< probability density of the direction per solid angle (1/sr)
  };
  /// Draws a direction. @param u, v  random numbers in [0, 1)
  Sample sample(double u, double v) const;
  /// Returns the probability density with which sample() draws a direction; 0: never.
  double density(const Vec3& direction) const;
  /// Returns the integral of radiance over all directions, as the mean of the colours.
  double flux() const { return rows_.back(); }

 private:
  std::size_t pixel_of(const Vec3& direction) const;
  double solid_angle(std::size_t row) const;
  double flux_of(std::size_t pixel) const;

  std::shared_ptr<const Panorama> picture_;
  Eigen::Array3d scale_;
  double turn_;
  std::vector<double> rows_, columns_;  ///< flux summed up to each row; to each pixel within its row
};

}  // namespace bin_scenes
