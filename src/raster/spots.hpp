/// Finds the nearest surface at given places of an image, by drawing triangles at these places only. The result is what
/// a ray through each place would meet, in double precision; if there are many places, it takes a fraction of the time.
#pragma once

#include "raster/projection.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace bin_scenes {

/// A point of an image for which the nearest surface is wanted.
struct Spot {
  double u = 0.0, v = 0.0;  ///< pixels, at most SpotDrawing::reach from the nearest pixel centre
  double near = 0.0;  ///< in: only surfaces with larger 1 / depth (1/m) are drawn; out: that of the nearest surface
  std::uint32_t face = Scenery::no_face;  ///< out: number of the face of that surface
};

class SpotDrawing {
 public:
  static constexpr double reach = 0.6;  ///< pixels, largest distance of a spot from the nearest pixel centre

  /// @param near, far  range of depths that are drawn (m)
  SpotDrawing(const Scenery& scenery, const Lens& lens, const Pose& pose, double near, double far);

  /// Draws the nearest surface at each point. Returns false, without drawing, if rays are faster for so few points, or
  /// if rays are required because of lens distortion or a mesh that reaches through the plane of the lens.
  bool draw(Spot* spots, std::size_t count) const;

 private:
  struct Band;
  struct Shape;
  void draw_band(Band& band) const;
  void draw_triangle(Band& band, const Projection::Body& body, const Projection::Covering& covering) const;
  void draw_floor(Band& band) const;

  const Scenery& scenery_;
  Lens lens_;
  Vec3 floor_;      ///< 1/m; 1 / depth of the floor on a ray (z = 1) is floor_ . ray
  double nearest_;  ///< 1/m, 1 / smallest depth that is drawn
  bool usable_;
  std::vector<Projection::Body> bodies_;
  std::vector<std::size_t> triangles_in_;  ///< number of triangles of all bodies in each band of rows
};

}  // namespace bin_scenes
