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

/// Light that a surface sends to an eye, over that which a white matte surface sends that faces the light: a matte
/// share and a lobe of facets (facets.hpp). Over the hemisphere it sends back its albedo. All directions are unit and
/// point away from the surface. 0 where one of them lies behind it.
double reflected(const Surface& surface, const Vec3& normal, const Vec3& to_light, const Vec3& to_eye);
/// The reflected light, divided into scattered and mirrored light, which have different colours.
struct SentBack {
  double matte = 0.0, mirrored = 0.0;
};
SentBack sent_back(const Surface& surface, const Vec3& normal, const Vec3& to_light, const Vec3& to_eye);
/// The share of light from everywhere that a surface sends back: what ambient light makes of it.
inline double diffuse_share(const Surface& surface) {
  return (1.0 - surface.gloss) * surface.albedo;
}

/// A point of the scene, bin frame.
struct SeenPoint {
  Vec3 position, normal;  ///< the normal turned towards the eye
  std::int32_t line = -1;
  bool hit = false;
  std::uint16_t label = 0;                ///< label of the part, whose texture the surface has
  std::uint32_t face = Scenery::no_face;  ///< no_face: not known
};

SeenPoint seen_point(const View& view, std::size_t pixel);

struct Lit {
  Validity code = Validity::nothing;  ///< valid, nothing, shadow or outside
  double column = 0.0, row = 0.0;     ///< position in the projector's image, if the point is in its field
  double distance = 0.0;              ///< m, from the light
  double reflected = 0.0;             ///< reflected light, see above; 0 unless the code is valid
};

/// What lights a scene. Shadows are those of the true meshes.
struct LightSource {
  const Scenery& scenery;
  const Lens& lens;
  const Pose& pose;
  const Surfaces& surfaces;
  // Data structures that make rays to points unnecessary.
  const ClearSight* sight = nullptr;       ///< regions that the light reaches; used where the face is known
  const SpotDrawing* occlusion = nullptr;  ///< all depths as seen from the light; used for many points
};

/// Light of a projector at points seen from an eye.
void light(const LightSource& source, const Vec3& eye, const SeenPoint* points, Lit* lit, std::size_t count);

/// Computes the light with a separate eye position for each point.
void light(const LightSource& source, const Vec3* eyes, const SeenPoint* points, Lit* lit, std::size_t count);

/// Ray from just above a surface to a point, for Scenery::blocked. The gap keeps single precision from letting a
/// surface occlude itself.
Ray ray_between(const Vec3& surface, const Vec3& normal, const Vec3& point);
/// Ray from there in a direction, and what it hits: a step of a path of light.
Ray ray_along(const Vec3& surface, const Vec3& normal, const Vec3& direction);
SeenPoint point_of(const Ray& ray, const Hit& hit);

}  // namespace bin_scenes
