/// Light that reaches a point via other surfaces. Patterns are linear in light: the light at a point is a set of
/// paths, each with a place in the pattern and a weight, and the same set serves every pattern (Gupta et al. 2013, "A
/// practical approach to 3D scanning in the presence of interreflections, subsurface scattering and defocus").
#pragma once

#include "bin_scenes/core/random.hpp"
#include "light/illumination.hpp"

#include <limits>
#include <vector>

namespace bin_scenes {

/// A light source that illuminates the scene, as interreflections use it.
class Lamp {
 public:
  virtual ~Lamp() = default;
  /// Computes the direct light at `count` points, each seen from an eye position of its own.
  virtual void light(const SeenPoint* points, const Vec3* eyes, Lit* lit, std::size_t count) const = 0;
  /// Returns the gradient (1/m) of the column of a point in the lamp's image, with respect to the point's position.
  virtual Vec3 slope(const Vec3& point, double column) const = 0;
  /// Returns the unit direction in which the lamp's light arrives at a point.
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
  Vec3 share_, ahead_;  ///< column = (share . p) / (ahead . p) for a point p relative to the projector; no distortion
};

struct Path {
  double column;  ///< column in the projector's image at which the path begins
  double weight;  ///< light that a white pattern sends to the eye; unit as Lit::reflected / distance^2 of direct light
  double spread;  ///< width of the range of columns that this sampled path represents
  Vec3 slope;     ///< 1/m, gradient of the column when the point moves while direction and planes stay the same
  double length;  ///< m, length of the path from the lamp via the other surfaces to the point
  Vec3 longer;    ///< gradient of the path length under the same motion
};

struct Gathered {
  std::vector<Path> paths;  ///< all sampled paths that carry light
  double nearness = 0.0;    ///< 1/m, mean over all rays of 1 / distance to the surface that they hit
};

/// The surfaces that rays can hit, and the lamp that lights them.
struct LitScene {
  const Scenery& scenery;
  const Surfaces& surfaces;
  const Lamp& lamp;
};

struct Search {
  int samples;  ///< number of rays, distributed like the lobe of the surface
  int bounces;  ///< 1: light reflected by one other surface; 2: also light reflected by two
  double too_near = std::numeric_limits<double>::infinity();  ///< 1/m, nearness from which on no light is gathered
};

/// Gathers the indirect light that a point sends to an eye. @param key  random numbers of this point
/// @return false if the surroundings were nearer than Search::too_near; `out` then has no paths
bool gather(const LitScene& scene, const SeenPoint& point, const Vec3& eye, const Search& search, Random key,
            Gathered& out);

}  // namespace bin_scenes
