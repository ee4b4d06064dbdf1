/// Determines which points a light reaches without occlusion. For most points, this is decided for a whole region and
/// without a ray for each point.
#pragma once

#include "bin_scenes/raster/lens.hpp"
#include "bin_scenes/raster/scenery.hpp"

#include <cstdint>
#include <vector>

namespace bin_scenes {

/// The field of a light in cells, and for each the mesh that comes nearest to the light in it, and how near another
/// one comes.
class ClearSight {
 public:
  /// For a lens with distortion, or a mesh that extends behind the light, no region is marked as clear.
  ClearSight(const Scenery& scenery, const Lens& light, const Pose& pose);

  /// Whether nothing is between the light and a point of a face or of the floor. False: a ray must be cast.
  /// @param there, pixel  the point in the light's frame and field
  bool clear(const Vec3& point, const Vec3& there, const Eigen::Vector2d& pixel, const Scenery::Face& face) const;

 private:
  struct Cell {
    std::uint32_t body;
    std::uint32_t plane;  ///< a triangle in whose plane all of the body's lie here; `bent`: there is none
    float first, second;  ///< largest 1 / depth of that body, and of all others
  };
  struct Seen;
  bool project(const Scenery::Body& body, Seen& seen) const;
  void mark(const Seen& seen, std::uint32_t triangle, std::uint32_t body);
  void mark_rows(const Seen& seen, std::uint32_t triangle, std::uint32_t body);
  void mark_cell(Cell& cell, const Seen& seen, std::uint32_t triangle, std::uint32_t body, double near);
  static bool one_plane(const Scenery::Plane& a, const Scenery::Plane& b);

  const Scenery& scenery_;
  Lens lens_;
  Mat3 turn_;    ///< bin to light
  Vec3 origin_;  ///< the light in the bin frame
  int columns_, rows_;
  std::vector<Cell> cells_;
};

}  // namespace bin_scenes
