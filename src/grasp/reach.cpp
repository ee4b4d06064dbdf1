#include "grasp/reach.hpp"

#include "grasp/gripper_shape.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace bin_scenes {

namespace {

constexpr double farthest_back = 3.0;  ///< m: longest approach
constexpr double upright = 0.02;       ///< rad: at a smaller angle of approach and lift, the lift follows the approach

/// Neighbours of a part by distance, because collisions with the nearest ones are the most frequent.
std::vector<std::size_t> order_around(const PlacedParts& placed, const PlacedPart& part) {
  const std::vector<PlacedPart>& all = placed.all();
  std::vector<std::pair<double, std::size_t>> by_distance;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].id == part.id) continue;
    by_distance.emplace_back(all[i].id < 0 ? 0.0 : (all[i].box.center() - part.box.center()).squaredNorm(), i);
  }
  std::sort(by_distance.begin(), by_distance.end());
  std::vector<std::size_t> order;
  for (const auto& [distance, i] : by_distance) order.push_back(i);
  return order;
}

}  // namespace

Reach::Reach(const PlacedParts& placed, const PlacedPart& part, const Gripper& gripper, const Vec3& lift)
    : placed_(placed), gripper_(gripper), lift_(lift), order_(order_around(placed, part)) {}

double Reach::height_to_top(const SceneGrasp& grasp) const {
  return placed_.top() - grasp.pose.position.dot(placed_.up()) + gripper_.finger_depth;
}

double Reach::way_back(const SceneGrasp& grasp) const {
  const double cosine = -(grasp.pose.orientation * Vec3::UnitZ()).dot(placed_.up());
  return std::clamp(height_to_top(grasp) / std::max(cosine, 0.05), 0.0, farthest_back);
}

bool Reach::meets(SceneGrasp& grasp) const {
  const double margin = gripper_.clearance;
  if (check(approach_sweeps(gripper_, grasp.aperture(), way_back(grasp), margin), SceneGrasp::Obstacle::approach,
            grasp) ||
      check(closing_sweeps(gripper_, grasp.aperture(), margin), SceneGrasp::Obstacle::closing, grasp))
    return true;
  if (-(grasp.pose.orientation * Vec3::UnitZ()).dot(lift_) > std::cos(upright)) return false;
  const double length = std::max(0.0, height_to_top(grasp)) / lift_.dot(placed_.up());
  const Vec3 lift = grasp.pose.orientation.conjugate() * (length * lift_);
  std::vector<Sweep> lifted;
  for (const Sweep& body : closed_shape(gripper_, grasp.aperture(), margin)) lifted.push_back(body.moved(lift));
  return check(lifted, SceneGrasp::Obstacle::lift, grasp);
}

double Reach::room(const SceneGrasp& grasp) const {
  const double wider = 2.0 * std::max(gripper_.clearance, 5e-4);
  for (const double factor : {1.0, 2.0}) {
    // The room beside the gripper counts. The distance of its tips from the floor is no measure of room.
    SceneGrasp tried = grasp;
    const double margin = factor * wider;
    tried.pose.position -= (margin - gripper_.clearance) * (grasp.pose.orientation * Vec3::UnitZ());
    if (check(approach_sweeps(gripper_, grasp.aperture(), way_back(grasp), margin), SceneGrasp::Obstacle::approach,
              tried) ||
        check(closing_sweeps(gripper_, grasp.aperture(), margin), SceneGrasp::Obstacle::closing, tried))
      return 0.5 * (factor - 1.0);
  }
  return 1.0;
}

bool Reach::check(const std::vector<Sweep>& sweeps, SceneGrasp::Obstacle where, SceneGrasp& grasp) const {
  for (const Sweep& sweep : sweeps) {
    const auto other = placed_.met_by(sweep.placed(grasp.pose), order_);
    if (!other) continue;
    grasp.obstacle = where;
    grasp.other = *other;
    return true;
  }
  return false;
}

}  // namespace bin_scenes
