/// Finds the nearest surface at given places of an image, by drawing triangles at these places only. The result is what
/// a ray through each place would meet, in double precision; if there are many places, it takes a fraction of the time.
#pragma once

#include "raster/projection.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace bin_scenes {

/// A place of an image.
struct Spot {
  double u = 0.0, v = 0.0;  ///< pixel, at most SpotDrawing::reach from the centre of one
  double near = 0.0;        ///< 1 / depth (1/m): only what is nearer is drawn, and is kept here
  std::uint32_t face = Scenery::no_face;
};

class SpotDrawing {
 public:
  static constexpr double reach = 0.6;

  /// @param near, far  m, depths that are drawn
  SpotDrawing(const Scenery& scenery, const Lens& lens, const Pose& pose, double near, double far);

  /// False: rays are as quick for so few places, or have to see: lines do not stay straight, or a mesh reaches through
  /// the plane of the lens. Nothing is drawn then.
  bool draw(Spot* spots, std::size_t count) const;

 private:
  struct Band;
  struct Shape;
  void draw_band(Band& band) const;
  void draw_triangle(Band& band, const Projection::Body& body, const Projection::Covering& covering) const;
  void draw_floor(Band& band) const;

  const Scenery& scenery_;
  Lens lens_;
  Vec3 floor_;      ///< 1 / depth of the floor = floor . ray
  double nearest_;  ///< 1 / depth
  bool usable_;
  std::vector<Projection::Body> bodies_;
  std::vector<std::size_t> triangles_in_;  ///< by band
};

}  // namespace bin_scenes
