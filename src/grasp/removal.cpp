/// A part is lifted straight up, against gravity, until it is above all others, or along the free direction nearest to
/// the vertical that the request permits. Parts that its mesh would collide with, or that press down on it, have to be
/// removed before it.
#include "grasp/removal.hpp"

#include "bin_scenes/core/cancel.hpp"
#include "bin_scenes/core/contact.hpp"
#include "bin_scenes/quality/quality.hpp"
#include "grasp/overlap.hpp"
#include "grasp/rays.hpp"
#include "grasp/separation.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

namespace bin_scenes {

namespace {

constexpr double lies_on = 0.05;       ///< a part with more load / weight of the lighter one lies on the other
constexpr double supports = 0.2;       ///< a contact whose normal has a larger upward component supports a part
constexpr double most_overlap = 0.02;  ///< / smaller diagonal: overlap of parts at rest that is removed before a lift
constexpr double side_play = 1e-3;     ///< / smaller diagonal: sideways play of a part in a gripper
constexpr double cone_step = 0.18;     ///< rad between the tilts of lifts that are tried
constexpr int cone_directions = 8;     ///< directions of lifts that are tried at each tilt
constexpr std::size_t together = 2;    ///< largest number of parts that are lifted together: one gripper holds them all

/// Forces that act on one part.
struct Acting {
  double load = 0.0, drag = 0.0;   ///< N: downwards; friction at the sides
  std::map<int, double> pressing;  ///< N downwards, by the id of the other part
};

/// The pose raised by `raise`, and moved a little sideways: otherwise, all edges of equal parts exactly above each
/// other would only touch.
Pose nudged(const PlacedPart& part, const Vec3& direction, double raise, double size) {
  const Vec3 center = part.box.center();
  const Quat turn(Eigen::AngleAxisd(1e-4, direction));
  const Vec3 moved = raise * direction + 1e-5 * size * direction.unitOrthogonal();
  return {center + turn * (part.pose.position - center) + moved, (turn * part.pose.orientation).normalized()};
}

/// Whether a ray from the part's surface along the direction enters the other part between `from` and `limit`. If so,
/// the other part obstructs it for certain, and no exact test is needed.
bool stands_over(const PlacedPart& other, const PlacedPart& part, const Vec3& direction, double limit, double from) {
  const Pose into = other.pose.inverse();
  const Vec3 along = into.orientation * direction;
  for (const Vec3& top : part.tops)
    for (const Passage& passage : passages(*other.mesh, into * top, along, from))
      if (passage.distance < limit && other.mesh->mesh().area_vector(passage.triangle).dot(along) < 0.0) return true;
  return false;
}

class Forces {
 public:
  Forces(const Scene& scene, const LoadedRequest& loaded, const Vec3& up) : request_(loaded.request), up_(up) {
    for (const ScenePart& part : scene.parts) line_[part.id] = part.line;
    for (const SceneContact& contact : scene.contacts) {
      add(contact.b, contact.a, contact.force, contact.normal);
      add(contact.a, contact.b, -contact.force, -contact.normal);
    }
  }
  const Acting& on(int id) const {
    static const Acting nothing;
    const auto found = acting_.find(id);
    return found == acting_.end() ? nothing : found->second;
  }

 private:
  double friction_of(int id) const { return id < 0 ? request_.bin.friction : request_.parts[line_.at(id)].friction; }
  /// @param normal  towards `id`
  void add(int id, int other, const Vec3& force, const Vec3& normal) {
    if (id < 0) return;
    Acting& acting = acting_[id];
    const double down = -force.dot(up_);
    if (other >= 0 && down > 0.0) {
      acting.load += down;
      if (normal.dot(up_) < -supports) acting.pressing[other] += down;  // at a side friction pulls, and nothing lies
    }
    if (normal.dot(up_) > supports) return;  // it is left as soon as the part goes up
    acting.drag += pair_friction(friction_of(id), friction_of(other)) * std::abs(force.dot(normal));
  }

  const Request& request_;
  Vec3 up_;
  std::map<int, std::size_t> line_;
  std::map<int, Acting> acting_;
};

/// Whether the part only grazes what it meets at the distance `free`: it passes if it is moved aside a little.
bool grazes(const PlacedPart& other, const PlacedPart& part, Pose pose, const Vec3& direction, double free,
            double limit) {
  const double play = side_play * std::min(part.box.diagonal(), other.box.diagonal());
  double aside = 0.0;
  while (free > 0.0) {
    const Pose met{pose.position + (free + play) * direction, pose.orientation};
    const Penetration overlap = penetration(*part.mesh, met, *other.mesh, other.pose);
    if (overlap.depth <= 0.0 || overlap.direction.dot(direction) > supports) return false;
    const double step = overlap.depth + 0.1 * play;
    aside += step;
    if (aside > play) return false;
    pose.position -= step * overlap.direction;
    free = free_distance(*part.mesh, pose, *other.mesh, other.pose, direction, limit);
    if (free >= limit) return true;
  }
  return false;
}

}  // namespace

bool hinders(const PlacedPart& other, const PlacedPart& part, const Vec3& direction, double limit) {
  Aabb swept = part.box;
  swept.extend(Vec3(part.box.lower + limit * direction));
  swept.extend(Vec3(part.box.upper + limit * direction));
  if (!swept.overlaps(other.box)) return false;
  const double smaller = std::min(part.box.diagonal(), other.box.diagonal());
  const SeparatingPlane plane =
      separating_plane({*part.mesh, part.pose}, limit * direction, {*other.mesh, other.pose}, side_play * smaller);
  if (plane.gap >= -side_play * smaller) return false;
  const Vec3 guide = plane.normal.dot(direction) >= 0.0 ? plane.normal : Vec3(Vec3::Zero());
  if (stands_over(other, part, direction, limit, 2e-3 * smaller)) return true;
  // Parts at rest overlap a little where they touch. A small raise separates a part from its support. At its sides, the
  // overlap is removed first, with a little play; only a part that still obstructs it then counts.
  for (const double raise : {1e-5, 2e-4, 2e-3}) {
    const Pose pose = nudged(part, direction, raise * smaller, smaller);
    const double free = free_distance(*part.mesh, pose, *other.mesh, other.pose, direction, limit, guide);
    if (free > 0.0) return free < limit && !grazes(other, part, pose, direction, free, limit);
    const Penetration overlap = penetration(*part.mesh, pose, *other.mesh, other.pose);
    // If the other part has to move up to leave the overlap, it lies on this one.
    if (overlap.depth > most_overlap * smaller || overlap.direction.dot(direction) > supports) return true;
    for (const double play : {1e-6, side_play}) {
      Pose apart = pose;
      apart.position -= (overlap.depth + play * smaller) * overlap.direction;
      const double then = free_distance(*part.mesh, apart, *other.mesh, other.pose, direction, limit, guide);
      if (then >= limit) return false;
      if (then > most_overlap * smaller) return true;
    }
  }
  return true;
}

namespace {

/// Whether a part can be moved by `move` without obstruction. It may slide along the parts that it touches.
bool passes(const PlacedParts& placed, const PlacedPart& part, const Vec3& move) {
  const double length = move.norm();
  if (!(length > 0.0)) return true;
  return std::none_of(placed.all().begin(), placed.all().end(), [&](const PlacedPart& other) {
    return other.id != part.id && hinders(other, part, move / length, length);
  });
}

void measure_overlaps(std::vector<PartPick>& picks, const PlacedParts& placed, double slight_overlap) {
  if (std::all_of(picks.begin(), picks.end(), [](const PartPick& pick) { return pick.blocked_by.empty(); })) return;
  std::map<int, std::size_t> index;
  for (std::size_t i = 0; i < placed.all().size(); ++i)
    if (placed.all()[i].id >= 0) index[placed.all()[i].id] = i;
  const Overlaps overlaps(placed);
  for (PartPick& pick : picks) {
    stop_if_cancelled();
    std::vector<std::size_t> above;
    for (const int id : pick.blocked_by) {
      pick.blocked_areas.push_back(id < 0 ? 0.0 : overlaps.area(index.at(pick.id), index.at(id)));
      if (id >= 0) above.push_back(index.at(id));
    }
    if (above.empty()) continue;
    pick.overlap = overlaps.of(index.at(pick.id), above);
    pick.overlap.passes = passes(placed, placed.all()[index.at(pick.id)], pick.overlap.move);
    pick.slight = above.size() == pick.blocked_by.size() && pick.overlap.share <= slight_overlap;
  }
}

}  // namespace

namespace {

/// The displacement nearest to the vertical, within the cone, that lifts the part above all others without a collision.
std::optional<Vec3> free_lift(const PlacedParts& placed, const PlacedPart& part, double height, double cone) {
  const Vec3 &up = placed.up(), across = up.unitOrthogonal();
  const int rings = static_cast<int>(std::ceil(cone / cone_step - 1e-9));
  for (int ring = 1; ring <= rings; ++ring) {
    const double tilt = cone * ring / rings;
    for (int k = 0; k < cone_directions; ++k) {
      const Vec3 aside = Eigen::AngleAxisd(2.0 * M_PI * k / cone_directions, up) * across;
      const Vec3 direction = std::cos(tilt) * up + std::sin(tilt) * aside;
      const double length = height / std::cos(tilt);
      const auto meets = [&](const PlacedPart& other) {
        return other.id != part.id && hinders(other, part, direction, length);
      };
      if (std::none_of(placed.all().begin(), placed.all().end(), meets)) return Vec3(length * direction);
    }
  }
  return std::nullopt;
}

}  // namespace

std::vector<PartPick> picks_of(const Scene& scene, const LoadedRequest& loaded, const PlacedParts& placed) {
  const Forces forces(scene, loaded, placed.up());
  const double gravity = loaded.request.gravity.norm();
  std::map<int, double> weight;
  for (const PlacedPart& part : placed.all())
    if (part.id >= 0) weight[part.id] = gravity * mass_of(loaded.request.parts[part.line], *loaded.parts[part.line]);
  std::vector<PartPick> picks;
  for (const PlacedPart& part : placed.all()) {
    if (!part.movable) continue;
    stop_if_cancelled();
    const Acting& acting = forces.on(part.id);
    PartPick pick;
    pick.id = part.id;
    pick.load = acting.load;
    pick.pull = weight[part.id] + acting.load + acting.drag;
    std::set<int> blocking;
    for (const auto& [other, force] : acting.pressing)
      if (force > lies_on * std::min(weight[part.id], weight[other])) blocking.insert(other);
    const double height = placed.top() - lowest(part.box, placed.up());
    pick.lift = height * placed.up();
    const bool lies_under_load = !blocking.empty();
    for (const PlacedPart& other : placed.all()) {
      const bool upright_walls = other.id < 0 && loaded.request.bin.kind == Bin::Kind::box;
      if (other.id == part.id || upright_walls || blocking.count(other.id)) continue;
      if (hinders(other, part, placed.up(), height)) blocking.insert(other.id);
    }
    if (!blocking.empty() && !lies_under_load)
      if (const auto lift = free_lift(placed, part, height, loaded.request.lift_cone)) {
        pick.lift = *lift;
        blocking.clear();
      }
    pick.blocked_by.assign(blocking.begin(), blocking.end());
    picks.push_back(std::move(pick));
  }
  measure_overlaps(picks, placed, loaded.request.slight_overlap);
  return picks;
}

namespace {

/// Removes parts one after another; those that block each other in pairs, or the least covered one first.
class Remover {
 public:
  Remover(std::vector<PartPick>& picks, const PlacedParts& placed) {
    for (const PlacedPart& part : placed.all()) height_[part.id] = highest(part.box, placed.up());
    for (PartPick& pick : picks) left_[pick.id] = &pick;
  }

  std::vector<int> order(std::vector<SceneGrasps::HeldSet>& sets) {
    while (!left_.empty()) {
      if (PartPick* next = highest_free()) {
        remove({next->id});
      } else if (const std::set<int> held = smallest_held(); !held.empty()) {
        sets.push_back(set_of(by_height(held)));
        if (held.size() <= together)
          remove(sets.back().ids);
        else
          unravel(sets.back());
      } else {
        std::set<int> rest;  // parts below something fixed, and those that they block
        for (const auto& [id, pick] : left_) rest.insert(id);
        for (const int id : by_height(rest)) order_.push_back(id);
        left_.clear();
      }
    }
    return order_;
  }

 private:
  PartPick* highest_free() const {
    PartPick* best = nullptr;
    for (const auto& [id, pick] : left_) {
      const auto is_out = [&](int other) { return depth_.count(other) != 0; };
      if (!std::all_of(pick->blocked_by.begin(), pick->blocked_by.end(), is_out)) continue;
      if (!best || height_.at(id) > height_.at(best->id)) best = pick;
    }
    return best;
  }

  /// m2 of it that parts cover which are still there.
  double covered(const PartPick& pick) const {
    double area = 0.0;
    for (std::size_t i = 0; i < pick.blocked_by.size(); ++i)
      if (left_.count(pick.blocked_by[i])) area += pick.blocked_areas.at(i);
    return area;
  }

  /// Removes a set part by part: the highest of those that are free, or if there is none the one that is covered least.
  void unravel(SceneGrasps::HeldSet& held) {
    std::vector<int> rest;
    rest.swap(held.ids);
    while (!rest.empty()) {
      const auto is_free = [&](int id) {
        const std::vector<int>& blocking = left_.at(id)->blocked_by;
        return std::none_of(blocking.begin(), blocking.end(), [&](int other) { return left_.count(other) != 0; });
      };
      auto next = std::find_if(rest.begin(), rest.end(), is_free);
      if (next == rest.end()) {
        next = std::min_element(rest.begin(), rest.end(),
                                [&](int a, int b) { return covered(*left_.at(a)) < covered(*left_.at(b)); });
        held.forced.push_back({*next, covered(*left_.at(*next))});
      }
      held.ids.push_back(*next);
      remove({*next});
      rest.erase(next);
    }
  }

  /// All parts that have to be removed before or together with a part; empty if one of them is fixed.
  std::set<int> needed_by(int id) const {
    std::set<int> all = {id};
    std::vector<int> open = {id};
    while (!open.empty()) {
      const PartPick& pick = *left_.at(open.back());
      open.pop_back();
      for (const int other : pick.blocked_by) {
        if (depth_.count(other)) continue;
        if (!left_.count(other)) return {};
        if (all.insert(other).second) open.push_back(other);
      }
    }
    return all;
  }

  /// The smallest set of parts that block each other; of equally small ones that of the lowest id.
  std::set<int> smallest_held() const {
    std::set<int> best;
    for (const auto& [id, pick] : left_) {
      const std::set<int> needed = needed_by(id);
      if (!needed.empty() && (best.empty() || needed.size() < best.size())) best = needed;
    }
    return best;
  }

  std::vector<int> by_height(const std::set<int>& ids) const {
    std::vector<int> sorted(ids.begin(), ids.end());
    std::stable_sort(sorted.begin(), sorted.end(), [&](int a, int b) { return height_.at(a) > height_.at(b); });
    return sorted;
  }

  SceneGrasps::HeldSet set_of(const std::vector<int>& ids) const {
    SceneGrasps::HeldSet held;
    held.ids = ids;
    for (const int id : ids) {
      const PartPick& pick = *left_.at(id);
      for (std::size_t i = 0; i < pick.blocked_by.size(); ++i) {
        if (!left_.count(pick.blocked_by[i])) continue;
        if (held.part >= 0 && pick.blocked_areas.at(i) >= held.overlap) continue;
        held.part = id;
        held.by = pick.blocked_by[i];
        held.overlap = pick.blocked_areas[i];
      }
    }
    return held;
  }

  /// Removes parts in the same round.
  void remove(const std::vector<int>& ids) {
    int depth = 0;
    for (const int id : ids)
      for (const int other : left_.at(id)->blocked_by)
        if (depth_.count(other)) depth = std::max(depth, depth_.at(other) + 1);
    for (const int id : ids) {
      left_.at(id)->depth = depth;
      depth_[id] = depth;
      left_.erase(id);
      order_.push_back(id);
    }
  }

  std::map<int, double> height_;
  std::map<int, PartPick*> left_;
  std::map<int, int> depth_;  ///< of the parts that were removed
  std::vector<int> order_;
};

}  // namespace

std::vector<int> order_removal(std::vector<PartPick>& picks, const PlacedParts& placed,
                               std::vector<SceneGrasps::HeldSet>& sets) {
  return Remover(picks, placed).order(sets);
}

}  // namespace bin_scenes
