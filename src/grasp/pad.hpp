/// A flat pad pressed onto a part: where it comes to lie, and what of it is in contact. Exact on the triangles.
#pragma once

#include "bin_scenes/part/mesh_query.hpp"

#include <optional>
#include <vector>

namespace bin_scenes {

/// Frame of a pad: it moves along -out; u and v span its rectangle.
struct Pad {
  Vec3 center;  ///< on the surface that it is to touch, or above it
  Vec3 u, v, out;
  double half_u, half_v;  ///< m
  double start;           ///< m: height over the centre from which it comes
  double give;            ///< m: what lies no deeper is in contact
  double friction;        ///< facets steeper than its cone allows do not count
};

struct PadContact {
  double height = 0.0;                    ///< m of the pad over Pad::center
  double share = 0.0;                     ///< area in contact / area of the pad
  double radius = 0.0;                    ///< m: mean distance of the contact from its centroid
  double friction = 0.0;                  ///< tangent of the angle between mean normal and Pad::out
  Eigen::Vector2d centroid, lower, upper; /**< of the contact, along u and v from Pad::center (m) */
  std::vector<Eigen::Vector2d> points;    ///< of an even grid over the pad, those in contact; else of its facets
};

/// None if nothing is there, or something obstructs the pad before it starts, or all is too steep.
std::optional<PadContact> press(const MeshQuery& mesh, const Pad& pad);

/// Integral of the distance from `from` over a plane polygon, counter-clockwise (m3).
double distance_integral(const std::vector<Eigen::Vector2d>& polygon, const Eigen::Vector2d& from);

}  // namespace bin_scenes
