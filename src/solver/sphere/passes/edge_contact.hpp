/// Contacts at sharp edges. The grid of a distance field rounds them off: within a cell of one its gradient leans over,
/// by up to half the angle between the faces, and its depth is of neither face. Where an edge of one part meets an edge
/// or a corner of the other, both are taken from the edges themselves.
#pragma once

#include "solver/sphere/shapes/contact_samples.hpp"
#include "solver/sphere/shapes/field.hpp"

#include <array>

namespace bin_scenes::sphere {

/// Deepest point of the field along the edge from p to q, whose ends both rise away from its inside.
/// @param lowest_end  of both ends' distances (m): what is no deeper needs no contact of its own
/// @return false if there is none; `point`, `gradient`, `distance` hold it otherwise
bool descend(const Field& field, const Vec3f& p, const Vec3f& q, const Vec3f& gradient_p, const Vec3f& gradient_q,
             float lowest_end, Vec3f& point, Vec3f& gradient, float& distance);

/// Where the edge from p to q crosses one of the other part: depth and direction are those of the nearest such edge,
/// along the common normal of both, if both can be pressed along it.
/// @param point, gradient, distance  the field's answer, replaced by the edges'
/// @return false if there is none; all is left as it was
bool cross_edges(const Samples& other, const Field& field, const Vec3f& p, const Vec3f& q, Vec3f& point,
                 Vec3f& gradient, float& distance);

/// A way out of a part: unit direction, and m to its surface (negative inside).
struct WayOut {
  Vec3f out;
  float distance;
};

/// Ways out, the shortest first.
struct WaysOut {
  static constexpr int most = 4;
  int count = 0;
  std::array<WayOut, most> way;
};

/// The ways out of a point within a cell of sharp edges, by the planes of the faces that meet there: inside all of
/// them each is one, outside there is one, that to the nearest edge or above its face. None where no edge is near.
WaysOut ways_out_at_edge(const Samples& other, const Field& field, const Vec3f& point);

/// Whether a line through `point` along the unit `direction` crosses a sharp edge of the other part within a cell,
/// which can be pressed along the `normal` of both.
/// @param out  the way out of the other part, roughly
bool passes_edge(const Samples& other, const Field& field, const Vec3f& point, const Vec3f& direction, const Vec3f& out,
                 Vec3f& normal);

}  // namespace bin_scenes::sphere
