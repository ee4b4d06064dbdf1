/// The light of a projector or laser on a surface: the share that reaches the camera, and the regions in shadow. Light
/// via other surfaces is in interreflection.hpp.
#pragma once

#include "bin_scenes/light/surfaces.hpp"
#include "bin_scenes/raster/view.hpp"
#include "bin_scenes/scene/validity.hpp"

#include <cstddef>
#include <vector>

namespace bin_scenes {

class ClearSight;
class SpotDrawing;

/// Returns the light that a surface reflects to an eye, relative to a white matte surface that faces the light. It is
/// the sum of a matte share and a lobe of facets (facets.hpp); over the hemisphere, it sums up to the albedo. All
/// directions are unit vectors that point away from the surface. The result is 0 if one of them is behind the surface.
double reflected(const Surface& surface, const Vec3& normal, const Vec3& to_light, const Vec3& to_eye);
/// The light of reflected(), split into scattered and mirrored light, which have different colours.
struct SentBack {
  double matte = 0.0, mirrored = 0.0;
};
SentBack sent_back(const Surface& surface, const Vec3& normal, const Vec3& to_light, const Vec3& to_eye);
/// Returns the share of uniform ambient light that a surface scatters.
inline double diffuse_share(const Surface& surface) {
  return (1.0 - surface.gloss) * surface.albedo;
}

/// A point of the scene that a camera or a ray sees; all vectors are in the bin frame.
struct SeenPoint {
  Vec3 position, normal;   ///< m, and unit normal on the side of the eye
  std::int32_t line = -1;  ///< index into Request::parts, or as in Hit::line
  bool hit = false;
  std::uint16_t label = 0;                ///< id + 1 of the part, which selects its texture; 0: the bin
  std::uint32_t face = Scenery::no_face;  ///< number of the face in the scenery; no_face: not known
};

SeenPoint seen_point(const View& view, std::size_t pixel);

struct Lit {
  Validity code = Validity::nothing;  ///< validity code: valid, nothing, shadow or outside
  double column = 0.0, row = 0.0;     ///< position in the projector's image, if the point is in its field
  double distance = 0.0;              ///< m, distance of the point from the light source
  double reflected = 0.0;             ///< result of reflected(); 0 unless the code is valid
};

/// A light source with the scene that it illuminates. Shadows are those of the true meshes.
struct LightSource {
  const Scenery& scenery;
  const Lens& lens;
  const Pose& pose;
  const Surfaces& surfaces;
  // Data structures that make rays to points unnecessary.
  const ClearSight* sight = nullptr;       ///< unoccluded regions; used where the face is known
  const SpotDrawing* occlusion = nullptr;  ///< draws all depths seen from the light; for many points
};

/// Computes the light of a projector at `count` points, all seen from one eye position (bin frame).
void light(const LightSource& source, const Vec3& eye, const SeenPoint* points, Lit* lit, std::size_t count);

/// Computes the light with a separate eye position for each point.
void light(const LightSource& source, const Vec3* eyes, const SeenPoint* points, Lit* lit, std::size_t count);

/// Returns a ray from just above a surface to a point, for Scenery::blocked. It starts with a gap of 10 micrometres, so
/// that rounding to single precision cannot let a surface occlude itself.
Ray ray_between(const Vec3& surface, const Vec3& normal, const Vec3& point);
/// ray_along() returns a ray from just above a surface in a direction; point_of() returns the point that a ray hit.
Ray ray_along(const Vec3& surface, const Vec3& normal, const Vec3& direction);
SeenPoint point_of(const Ray& ray, const Hit& hit);

}  // namespace bin_scenes
