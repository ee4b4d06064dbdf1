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
  Vec3 center;  ///< on the surface that it shall touch, or above it
  Vec3 u, v, out;
  double half_u, half_v;  ///< m
  double start;           ///< m: height over the centre at which it starts to move
  double give;            ///< m: depth below the highest point down to which the surface is in contact
  double friction;        ///< coefficient; facets outside of its friction cone do not count
};

struct PadContact {
  double share = 0.0;                     ///< area in contact / area of the pad
  double radius = 0.0;                    ///< m: mean distance of the area of contact from its centroid
  double friction = 0.0;                  ///< tangent of the angle between mean normal and Pad::out
  Eigen::Vector2d centroid, lower, upper; /**< of the area of contact, along u and v from Pad::center (m) */
  std::vector<Eigen::Vector2d> points;    ///< those of an even grid over the pad that are in contact; of a contact
                                          ///< smaller than the grid, centres of some facets
};

/// A triangle of the part, clipped to the rectangle of a pad.
struct PadFacet {
  struct Polygon {
    static constexpr int most = 10;  ///< a triangle that is clipped at five planes has at most eight corners
    std::array<Vec3, most> points;   ///< m along u, v and out from Pad::center
    int count = 0;
    void add(const Vec3& point) { points[static_cast<std::size_t>(count++)] = point; }
    double highest() const;
  };
  Polygon polygon;
  Vec3 normal;  ///< unit; along u, v and out
};

/// A pad where it rests on a part. Whether it can get there may be asked before the contact is measured, which takes
/// most of the time.
class PressedPad {
 public:
  /// None if nothing is below the pad, or if something obstructs it before it starts. The mesh must outlive the result.
  static std::optional<PressedPad> on(const MeshQuery& mesh, const Pad& pad);
  double height() const { return height_; }  ///< m of the pad over Pad::center
  /// None if all facets below the pad are too steep.
  std::optional<PadContact> contact() const;

 private:
  PressedPad(const MeshQuery& mesh, const Pad& pad, double height) : mesh_(mesh), pad_(pad), height_(height) {}

  const MeshQuery& mesh_;
  Pad pad_;
  double height_;
};

/// Integral over a plane polygon, counter-clockwise, of the distance from a point (m3).
double distance_integral(const std::vector<Eigen::Vector2d>& polygon, const Eigen::Vector2d& from);

}  // namespace bin_scenes
