/// Projects meshes into the image of a pinhole camera, and sorts their triangles by the rows that they cover.
/// drawing.hpp and spots.hpp draw from it.
#pragma once

#include "bin_scenes/raster/lens.hpp"
#include "bin_scenes/raster/scenery.hpp"
#include "raster/spans.hpp"

#include <cstdint>
#include <vector>

namespace bin_scenes {

class Projection {
 public:
  static constexpr int band_rows = 16;  ///< the pixels of a band stay in the processor's cache

  /// A triangle and the pixels that it may touch, inclusive.
  struct Covering {
    std::uint32_t triangle;
    std::int16_t top, bottom, left, right;
  };
  struct Body {
    Scenery::Body placed;
    Mat3 turn;   ///< mesh to camera
    Vec3 place;  ///< m
    std::vector<ImageCorner> corners;
    bool one_sided = false;  ///< all that is seen of it faces the camera
    int first_band = 0;
    std::vector<std::vector<Covering>> bands;
  };

  /// @param reach  pixels from the centre of a pixel to its farthest point that is needed; 0: centres only
  Projection(const Lens& lens, double near, double far, double reach)
      : lens_(lens), nearest_(1.0 / near), farthest_(1.0 / far), reach_(reach + on_edge) {}

  /// Of a body whose `placed` is set. False: the mesh reaches through the plane of the lens, or is not as whole as it
  /// has to be.
  bool place(Body& body, const Pose& mesh_in_camera, bool whole) const;

 private:
  void sort_into_bands(Body& body) const;

  Lens lens_;
  double nearest_, farthest_;  // inverse depths (1/m) of the lens's near and far limit
  double reach_;
};

}  // namespace bin_scenes
