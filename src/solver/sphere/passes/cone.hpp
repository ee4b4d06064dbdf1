/// The directions in which a point of a part's surface can be pressed: its normal cone. The grid of a distance field
/// rounds edges off, so within a cell of one its gradient leans over; of two parts whose edges lie flush it would press
/// one sideways off the other. What the point of the sample's own surface cannot feel is taken out of the gradient.
#pragma once

#include "solver/sphere/math.hpp"

#include <array>

namespace bin_scenes::sphere {

/// Outward directions, body frame. A face has one, and a curved face those of its surroundings; an edge those between
/// its two faces; a corner those between its edges; where the surface is not convex, all.
struct Cone {
  static constexpr int max_bounds = 6;

  Vec3f axis = Vec3f::Zero();  ///< of a face
  float spread = 0;            ///< rad around the axis
  int bounds = 0;              ///< of an edge or corner; neither bounds nor axis: all directions
  std::array<Vec3f, max_bounds> bound =
      filled();  ///< the cone is { n : n . bound <= 0 for every bound }; unit vectors along the surface

  bool all() const { return bounds == 0 && axis.isZero(); }
  /// What leans over more than 84 degrees does not press.
  static constexpr float least_left = 0.1f;

  /// Turns a unit direction into the cone; false if less than `least` of it is left there (cosine of the turn).
  bool restrict(Vec3f& direction, float least = least_left) const;

  /// Unit direction in the middle of the cone; 0 of a cone of all directions.
  Vec3f middle() const;

 private:
  static std::array<Vec3f, max_bounds> filled() {
    std::array<Vec3f, max_bounds> zeros;
    zeros.fill(Vec3f::Zero());
    return zeros;
  }
};

}  // namespace bin_scenes::sphere
