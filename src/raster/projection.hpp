/// Projects meshes into the image of a pinhole camera, and sorts their triangles by the rows that they cover. The code
/// in drawing.hpp and spots.hpp draws these triangles.
#pragma once

#include "bin_scenes/raster/lens.hpp"
#include "bin_scenes/raster/scenery.hpp"
#include "raster/spans.hpp"

#include <cstdint>
#include <vector>

namespace bin_scenes {

class Projection {
 public:
  static constexpr int band_rows = 16;  ///< rows of a band; so few that its pixels stay in the processor's cache

  /// A triangle, and the range of rows and columns (inclusive) of the pixels that it may cover.
  struct Covering {
    std::uint32_t triangle;
    std::int16_t top, bottom, left, right;
  };
  struct Body {
    Scenery::Body placed;
    Mat3 turn;   ///< rotation from the frame of the mesh to the camera frame
    Vec3 place;  ///< m, origin of the mesh in the camera frame
    std::vector<ImageCorner> corners;
    bool one_sided = false;  ///< only triangles that face the camera are visible, and only these are kept
    int first_band = 0;
    std::vector<std::vector<Covering>> bands;
  };

  /// @param reach  largest distance (pixels) of a point that is drawn from the centre of its pixel; 0: only centres
  Projection(const Lens& lens, double near, double far, double reach)
      : lens_(lens), nearest_(1.0 / near), farthest_(1.0 / far), reach_(reach + on_edge) {}

  /// Projects a body whose `placed` is set. Returns false if rays are required: the mesh reaches through the plane of
  /// the lens, or, if `whole` is set, is only partly in the range of depths.
  bool place(Body& body, const Pose& mesh_in_camera, bool whole) const;

 private:
  void sort_into_bands(Body& body) const;

  Lens lens_;
  double nearest_, farthest_;  // inverse depths (1/m) of the lens's near and far limit
  double reach_;
};

}  // namespace bin_scenes
