/// A flat pad that is pressed onto a part: where it comes to rest, and the area of contact. The results are exact for
/// the triangles of the mesh.
#pragma once

#include "bin_scenes/part/mesh_query.hpp"

#include <array>
#include <limits>
#include <optional>
#include <vector>

namespace bin_scenes {

/// The frame of a pad. The pad moves along -out; u and v span its rectangle.
struct Pad {
  Vec3 center;            ///< point on the surface that the pad shall touch, or above it (m)
  Vec3 u, v, out;         ///< unit axes: u and v along the sides, out away from the part
  double half_u, half_v;  ///< m: half lengths of the sides along u and v
  double start;           ///< m: height above `center` at which the pad starts to move
  double give;            ///< m: depth below the highest point of the surface down to which it is in contact
  double friction;        ///< friction coefficient; facets outside of the friction cone do not count
};

struct PadContact {
  double share = 0.0;                     ///< area in contact / area of the pad
  double radius = 0.0;                    ///< m: mean distance of the contact area from its centroid
  double friction = 0.0;                  ///< tangent of the angle between the mean normal of the contact and Pad::out
  Eigen::Vector2d centroid, lower, upper; /**< of the area of contact, along u and v from Pad::center (m) */
  std::vector<Eigen::Vector2d> points;    ///< points of an even grid over the pad that are in contact; if the contact
                                          ///< is smaller than the grid, centres of some facets
};

/// A triangle of the part, clipped to the rectangle of a pad.
struct PadFacet {
  struct Polygon {
    static constexpr int most = 10;  ///< a triangle that is clipped at five planes has at most eight corners
    std::array<Vec3, most> points;   ///< corners: coordinates (m) along u, v and out from Pad::center
    int count = 0;
    void add(const Vec3& point) { points[static_cast<std::size_t>(count++)] = point; }
    double highest() const;
  };
  Polygon polygon;
  Vec3 normal;  ///< unit outward normal; components along u, v and out
};

/// A pad at the position where it rests on a part. The position may be used before the contact is measured, which takes
/// most of the time.
class PressedPad {
 public:
  /// Presses a pad on a mesh that outlives the result. None if no surface is below it, or if one obstructs its start.
  static std::optional<PressedPad> on(const MeshQuery& mesh, const Pad& pad);
  double height() const { return height_; }  ///< returns the height (m) of the resting pad above Pad::center
  /// Measures the contact; returns none if all facets below the pad are too steep.
  std::optional<PadContact> contact() const;

 private:
  PressedPad(const MeshQuery& mesh, const Pad& pad, double height) : mesh_(mesh), pad_(pad), height_(height) {}

  const MeshQuery& mesh_;
  Pad pad_;
  double height_;
};

/// Returns the integral of the distance from a point over the area of a counter-clockwise polygon (m3).
double distance_integral(const std::vector<Eigen::Vector2d>& polygon, const Eigen::Vector2d& from);

}  // namespace bin_scenes
