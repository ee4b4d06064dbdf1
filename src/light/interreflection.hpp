/// Light that reaches a point via other surfaces. Patterns are linear in light: the light at a point is a set of
/// paths, each with a place in the pattern and a weight, and the same set serves every pattern (Gupta et al. 2013, "A
/// practical approach to 3D scanning in the presence of interreflections, subsurface scattering and defocus").
#pragma once

#include "bin_scenes/core/random.hpp"
#include "light/illumination.hpp"

#include <limits>
#include <vector>

namespace bin_scenes {

/// What lights the scene.
class Lamp {
 public:
  virtual ~Lamp() = default;
  /// Light of `count` points, each seen by an eye of its own.
  virtual void light(const SeenPoint* points, const Vec3* eyes, Lit* lit, std::size_t count) const = 0;
  /// Returns the gradient of the column with respect to the position of a point (1/m).
  virtual Vec3 slope(const Vec3& point, double column) const = 0;
  /// Unit, the direction of its light at a point.
  virtual Vec3 direction_at(const Vec3& point) const = 0;
};

class ProjectorLamp : public Lamp {
 public:
  ProjectorLamp(const Scenery& scenery, const Lens& projector, const Pose& pose, const Surfaces& surfaces);
  void light(const SeenPoint* points, const Vec3* eyes, Lit* lit, std::size_t count) const override;
  Vec3 slope(const Vec3& point, double column) const override;
  Vec3 direction_at(const Vec3& point) const override { return (point - pose_.position).normalized(); }

 private:
  const Scenery& scenery_;
  Lens projector_;
  Pose pose_;
  const Surfaces& surfaces_;
  Vec3 share_, ahead_;  ///< column = share . p / ahead . p, of a point p seen from the projector; distortion left out
};

struct Path {
  double column;  ///< position in the projector's image
  double weight;  ///< white light that reaches the eye: Lit::reflected / distance^2 as of direct light
  double spread;  ///< columns that the sample stands for, from one side to the other
  Vec3 slope;     ///< 1/m, gradient of the column when the point moves while the direction and all planes stay the same
  double length;  ///< m, from the lamp via the other surfaces to the point
  Vec3 longer;    ///< gradient of the path length under the same motion
};

struct Gathered {
  std::vector<Path> paths;  ///< the paths that are lit
  double nearness = 0.0;    ///< 1/m, mean over the samples of 1 / distance to what they meet
};

/// The surfaces that rays can hit, and the lamp that lights them.
struct LitScene {
  const Scenery& scenery;
  const Surfaces& surfaces;
  const Lamp& lamp;
};

struct Search {
  int samples;  ///< rays, as the surface takes light
  int bounces;  ///< 1: light that met one other surface; 2: that which met two as well
  double too_near = std::numeric_limits<double>::infinity();  ///< 1/m, nearness from which on nothing is lit
};

/// @param key     of the random numbers of this point
/// @return false  it was too near
bool gather(const LitScene& scene, const SeenPoint& point, const Vec3& eye, const Search& search, Random key,
            Gathered& out);

}  // namespace bin_scenes
