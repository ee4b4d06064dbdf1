/// The lamps of the sensor model `image`: random points on a lamp, and the radiance that a ray finds if it hits a lamp.
/// path_tracer.hpp combines both by multiple importance sampling.
#pragma once

#include "bin_scenes/light/image_lamp.hpp"
#include "bin_scenes/raster/lens.hpp"
#include "bin_scenes/scene/request.hpp"
#include "light/sky.hpp"

#include <algorithm>
#include <vector>

namespace bin_scenes {

using Rgb = Eigen::Array3d;  ///< red, green, blue

class Lamps {
 public:
  /// @param lamps   none: one dome
  /// @param sensor  where the camera and its projector are; their poses and K are filled in
  Lamps(std::vector<ImageLamp> lamps, const Sensor& sensor);
  /// Light from everywhere, of so much radiance.
  void add_everywhere(double radiance);

  /// A point on a lamp as another point sees it.
  struct Sample {
    Vec3 direction;           ///< unit, to the lamp
    double distance = 0.0;    ///< m
    Rgb light = Rgb::Zero();  ///< radiance / density; 0: the lamp does not shine there
    double density = 0.0;     ///< per solid angle (1/sr), with that of choosing the lamp; 0: no ray meets that lamp
  };
  /// @param choice, u, v  [0, 1)
  Sample sample(const Vec3& from, double choice, double u, double v) const;

  /// Weight of a lamp that is met by a ray, by the density (1/sr) with which sample() draws that direction.
  enum class Met {
    all,        ///< 1: nothing else counts this light
    unsampled,  ///< 0 where sample() counts it, too
    shared      ///< as the ray's own density is to both (Veach, Guibas 1995, "Optimally combining sampling techniques")
  };
  /// Radiance that comes against a ray of unit direction.
  /// @param reach    m to the surface that the ray hits; infinite: none
  /// @param density  of the ray (1/sr)
  Rgb met(const Vec3& origin, const Vec3& direction, double reach, Met weight, double density) const;

  bool any_sampled() const { return !shares_.empty(); }
  /// Whether met() counts anything with that weight.
  bool any_met(Met weight) const { return any_behind_all(weight) || (weight != Met::unsampled && !flats_.empty()); }
  /// Returns the radiance of lamps that are behind all surfaces, such as the sky.
  bool any_behind_all(Met weight) const { return !domes_.empty() || (weight != Met::unsampled && !skies_.empty()); }
  /// Whether a ray hits a lamp with a position, whatever is between.
  bool flat_ahead(const Vec3& origin, const Vec3& direction, Met weight) const;
  /// Radiance of a white matte plate that nothing occludes.
  Rgb on_plate(const Vec3& point, const Vec3& normal) const;

 private:
  struct Flat {
    Vec3 center, x, y, normal;
    Rgb radiance;
    bool ring;
    double width, height;  ///< m; for a ring, the inner and the outer radius
    double area;
  };
  struct Dome {
    Rgb zenith, horizon;
    Rgb at(double up) const { return horizon + std::max(up, 0.0) * (zenith - horizon); }
  };
  struct Beam {
    Lens lens;
    Pose pose;
    Rgb radiance;
  };
  /// m along a ray of unit direction to where it meets the lamp's front; NaN: it does not.
  static double distance_to(const Flat& flat, const Vec3& origin, const Vec3& direction);
  /// @param share  of all samples that choose this lamp
  void sample_one(std::size_t lamp, double share, const Vec3& from, double u, double v, Sample& out) const;
  void sample_flat(const Flat& flat, double share, const Vec3& from, double u, double v, Sample& out) const;
  static void sample_beam(const Beam& beam, double share, const Vec3& from, Sample& out);

  std::vector<Flat> flats_;
  std::vector<Beam> beams_;
  std::vector<Dome> domes_;
  std::vector<Sky> skies_;
  std::vector<double> shares_;  ///< share of the samples of each lamp: flats, beams, skies; their sum is 1
};

}  // namespace bin_scenes
