/// Start poses of parts above the growing heap or on a grid. The poses overlap neither each other nor the parts in the
/// bin. Random numbers come from the stream of the scene, so that the same seed gives the same poses.
#pragma once

#include "bin_scenes/core/random.hpp"
#include "bin_scenes/part/part_model.hpp"
#include "bin_scenes/scene/request.hpp"

#include <optional>
#include <vector>

namespace bin_scenes {

/// A few dozen balls that together enclose every triangle of a mesh. They are as cheap to compare as a box, but they
/// follow the holes and arms of a part.
struct Cover {
  struct Ball {
    Vec3 center;
    double radius;
  };
  std::vector<Ball> balls;     ///< balls in the model frame (m)
  Vec3 center = Vec3::Zero();  ///< centre of one sphere around all balls
  /// Radius of that sphere (m).
  double radius = 0.0;
};
/// Makes the cover of a mesh with `cells` cells along its longest side; each ball encloses the triangles of one cell.
Cover cover(const Mesh& mesh, int cells = 5);

/// The box in which parts may enter: x and y between the walls, z from the floor to the rim (m, bin frame).
struct Opening {
  /// A side of the opening as seen from above: parts must stay where normal * (x, y) <= distance (m).
  struct Side {
    double normal_x, normal_y, distance;
  };
  Vec3 lower, upper;
  std::vector<Side> sides{};  ///< the convex outline of a mesh bin, which may cut off corners of the box
};
/// Returns the sides of the convex outline of a mesh, seen from above.
std::vector<Opening::Side> outline(const Mesh& mesh);

/// Finds start poses above the heap by a column search: the lowest height at which the balls of the part clear the
/// balls of everything below and beside it.
class Rain {
 public:
  Rain(const Opening& opening, double drop_height) : opening_(opening), drop_height_(drop_height) {}

  /// Adds a part that is in the bin. @param settled  whether it is slow enough to count as a part of the heap; parts
  /// that still fall are only avoided
  void add(const Cover& cover, const Pose& pose, bool settled);
  /// Returns a random pose of the model frame. The orientation is uniform among those that fit between the walls. Of
  /// `tries` uniformly distributed places between the walls, the lowest is taken; the lowest point of the part is then
  /// drop_height above the heap. Returns none if every try ends above the rim, or if all end high above parts that
  /// still fall.
  std::optional<Pose> place(const PartModel& part, const Cover& shape, Random& random, int tries);

 private:
  struct Obstacle {
    const Cover* cover;
    Pose pose;
    bool settled;
    Vec3 center;              ///< centre of the sphere around its cover
    std::vector<Vec3> balls;  ///< centres of the balls of its cover, made on first use
  };
  void sort();
  static const std::vector<Vec3>& balls_of(Obstacle& obstacle);

  Opening opening_;
  double drop_height_;
  std::vector<Obstacle> obstacles_;
  /// Height of the top of each cover (m) and the index of its obstacle, the highest first.
  std::vector<std::pair<double, std::size_t>> order_;
  bool sorted_ = false;
};

/// Returns the start poses of the thesis: a three-dimensional grid above the opening with random orientations. The edge
/// of a cell is spacing * bounding diameter of the largest part, and there are as many columns as fit between the
/// walls, at least one. The poses of the model frames are in the order of `parts`.
std::vector<Pose> grid_poses(const std::vector<const PartModel*>& parts, const Opening& opening, double spacing,
                             Random& random);

}  // namespace bin_scenes
