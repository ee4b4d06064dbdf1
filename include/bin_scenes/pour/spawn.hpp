/// Start poses of parts, above the growing heap or on a grid. They overlap nothing.
#pragma once

#include "bin_scenes/core/random.hpp"
#include "bin_scenes/part/part_model.hpp"
#include "bin_scenes/scene/request.hpp"

#include <optional>
#include <vector>

namespace bin_scenes {

/// A few dozen spheres that together enclose every triangle of a mesh. Like a box they are cheap bounds, but they
/// follow holes and arms.
struct Cover {
  struct Ball {
    Vec3 center;
    double radius;
  };
  std::vector<Ball> balls;     ///< model frame, m
  Vec3 center = Vec3::Zero();  ///< of one sphere around all of them
  double radius = 0.0;
};
/// `cells` along the longest side of the mesh; each ball bounds what lies in one cell.
Cover cover(const Mesh& mesh, int cells = 5);

/// Box in which parts may enter: x and y between walls, z from floor to rim.
struct Opening {
  /// Seen from above, parts stay where normal * (x, y) <= distance.
  struct Side {
    double normal_x, normal_y, distance;
  };
  Vec3 lower, upper;
  std::vector<Side> sides{};  ///< of a mesh bin: its convex outline, which may leave corners of the box free
};
/// Sides of the convex outline of a mesh, seen from above.
std::vector<Opening::Side> outline(const Mesh& mesh);

/// Finds start poses above the heap by a column search: the lowest height at which the balls of the part clear those of
/// everything below and beside it.
class Rain {
 public:
  Rain(const Opening& opening, double drop_height) : opening_(opening), drop_height_(drop_height) {}

  /// Adds a part that is in the bin. @param settled  it is slow enough to count as heap; parts that still fall are only
  /// avoided
  void add(const Cover& cover, const Pose& pose, bool settled);
  /// A seeded pose of the model frame. The orientation is uniform among those that fit between the walls. Of `tries`
  /// uniform places between the walls the lowest is taken, with the lowest point of the part drop_height above the
  /// heap. None if no try ends below the rim, or all end high above parts that still fall.
  std::optional<Pose> place(const PartModel& part, const Cover& shape, Random& random, int tries);

 private:
  struct Obstacle {
    const Cover* cover;
    Pose pose;
    bool settled;
    Vec3 center;              ///< of its cover
    std::vector<Vec3> balls;  ///< centres of the balls of its cover, made on first use
  };
  void sort();
  static const std::vector<Vec3>& balls_of(Obstacle& obstacle);

  Opening opening_;
  double drop_height_;
  std::vector<Obstacle> obstacles_;
  std::vector<std::pair<double, std::size_t>> order_;  ///< tops of their covers (m), which of them; the highest first
  bool sorted_ = true;
};

/// The thesis's start: a 3-D grid above the opening, cell edge = spacing * bounding diameter of the largest part, as
/// many columns as fit between the walls (at least one), seeded orientations. Poses of the model frames in the order
/// of `parts`.
std::vector<Pose> grid_poses(const std::vector<const PartModel*>& parts, const Opening& opening, double spacing,
                             Random& random);

}  // namespace bin_scenes
