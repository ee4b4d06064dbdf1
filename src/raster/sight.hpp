/// Determines which points a light reaches without occlusion. For most points, this is decided for a whole region and
/// without a ray for each point.
#pragma once

#include "bin_scenes/raster/lens.hpp"
#include "bin_scenes/raster/scenery.hpp"

#include <cstdint>
#include <vector>

namespace bin_scenes {

/// The image of a light, divided into cells of two pixels. Each cell stores the mesh that is nearest to the light
/// within it, and the smallest depth of all other meshes.
class ClearSight {
 public:
  /// For a lens with distortion, or a mesh that extends behind the light, no region is marked as clear.
  ClearSight(const Scenery& scenery, const Lens& light, const Pose& pose);

  /// Returns true if certainly nothing occludes a point on a face or on the floor; if false, a ray has to be cast.
  /// @param there, pixel  the point in the frame of the light (m), and its position in the light's image (pixels)
  bool clear(const Vec3& point, const Vec3& there, const Eigen::Vector2d& pixel, const Scenery::Face& face) const;

 private:
  struct Cell {
    std::uint32_t body;   ///< index of the body that is nearest to the light in this cell
    std::uint32_t plane;  ///< a triangle in whose plane all triangles of that body in this cell are; `bent`: none
    float first, second;  ///< 1/m: largest 1 / depth of that body, and of all other bodies
  };
  struct Seen;
  bool project(const Scenery::Body& body, Seen& seen) const;
  void mark(const Seen& seen, std::uint32_t triangle, std::uint32_t body);
  void mark_rows(const Seen& seen, std::uint32_t triangle, std::uint32_t body);
  void mark_cell(Cell& cell, const Seen& seen, std::uint32_t triangle, std::uint32_t body, double near);
  static bool one_plane(const Scenery::Plane& a, const Scenery::Plane& b);

  const Scenery& scenery_;
  Lens lens_;
  Mat3 turn_;    ///< rotation from the bin frame to the frame of the light
  Vec3 origin_;  ///< m, position of the light in the bin frame
  int columns_, rows_;
  std::vector<Cell> cells_;
};

}  // namespace bin_scenes
