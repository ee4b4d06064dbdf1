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
  /// @param lamps   lamps of the request; if empty, one dome is used
  /// @param sensor  gives the poses and K of camera and projector, which must be filled in
  Lamps(std::vector<ImageLamp> lamps, const Sensor& sensor);
  /// Adds uniform light from all directions with this radiance.
  void add_everywhere(double radiance);

  /// A random point on a lamp, as seen from the point that it illuminates.
  struct Sample {
    Vec3 direction;           ///< unit vector towards the lamp
    double distance = 0.0;    ///< m, distance of the lamp
    Rgb light = Rgb::Zero();  ///< radiance / density; 0: the lamp does not shine in that direction
    double density = 0.0;     ///< probability density (1/sr), choice of lamp included; 0: no ray can hit it
  };
  /// Draws a lamp and a point on it. @param u, v  random numbers in [0, 1); u chooses the lamp as well
  Sample sample(const Vec3& from, double u, double v) const;

  /// How met() weights a lamp that a ray hits, so that light that sample() finds as well is not counted twice.
  enum class Met {
    all,        ///< weight 1: sample() is not used
    unsampled,  ///< weight 0 for lamps that sample() can draw, 1 for others
    shared      ///< the ray's density / sum of both densities (balance heuristic: Veach, Guibas 1995)
  };
  /// Returns the weighted radiance of all lamps that a ray with a unit direction meets.
  /// @param reach    distance (m) of the surface that the ray hits; infinite if it hits none
  /// @param density  probability density with which the direction of the ray was drawn (1/sr)
  Rgb met(const Vec3& origin, const Vec3& direction, double reach, Met weight, double density) const;

  bool any_sampled() const { return !shares_.empty(); }
  /// Whether met() can return light with that weight.
  bool any_met(Met weight) const { return any_behind_all(weight) || (weight != Met::unsampled && !flats_.empty()); }
  /// Whether met() counts, with that weight, lamps that are behind all surfaces, such as the sky.
  bool any_behind_all(Met weight) const { return !domes_.empty() || (weight != Met::unsampled && !skies_.empty()); }
  /// Whether a ray hits a lamp with a position (area or ring), regardless of surfaces in between.
  bool flat_ahead(const Vec3& origin, const Vec3& direction, Met weight) const;
  /// Returns the radiance of a white matte plate at a point, if nothing occludes the lamps.
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
  /// Returns the distance (m) at which a ray with a unit direction hits the front of the lamp; NaN if it does not.
  static double distance_to(const Flat& flat, const Vec3& origin, const Vec3& direction);
  /// Draws a point on one lamp. @param share  share of all samples that choose this lamp
  void sample_one(std::size_t lamp, double share, const Vec3& from, double u, double v, Sample& out) const;
  void sample_flat(const Flat& flat, double share, const Vec3& from, double u, double v, Sample& out) const;
  static void sample_beam(const Beam& beam, double share, const Vec3& from, Sample& out);

  std::vector<Flat> flats_;
  std::vector<Beam> beams_;
  std::vector<Dome> domes_;
  std::vector<Sky> skies_;
  std::vector<double> shares_;  ///< share of the samples that each lamp gets: flats_, beams_, skies_; their sum is 1
};

}  // namespace bin_scenes
