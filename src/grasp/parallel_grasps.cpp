/// Lines through the part yield pairs of opposite points. The gripper is turned around the axis of each pair in steps,
/// and its pads are then pressed onto the exact mesh.
#include "grasp/parallel_grasps.hpp"

#include "bin_scenes/core/cancel.hpp"
#include "grasp/directions.hpp"
#include "grasp/gripper_shape.hpp"
#include "grasp/pad.hpp"
#include "grasp/rays.hpp"
#include "grasp/surface_points.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes {

namespace {

constexpr std::size_t points_tried = 700;
constexpr double same_place = 1e-6;      ///< / diagonal: rounding of lengths
constexpr double least_contact = 0.005;  ///< smallest share of the pad that must be in contact

/// The points where a line enters and leaves the part or, from within, where it crosses a hole, and the direction from
/// `far` to `near`.
struct Pair {
  Vec3 near, far, axis;
  bool inner = false;
};

/// The gripper's frame with closing axis x, and z turned about it from a direction across it.
Pose pose_about(const Pair& pair, const Vec3& from, double turn) {
  const Vec3 z = Eigen::AngleAxisd(turn, pair.axis) * from;
  Mat3 frame;
  frame << pair.axis, z.cross(pair.axis), z;
  return {0.5 * (pair.near + pair.far), Quat(frame).normalized()};
}

bool fits(const Gripper& gripper, double width, bool inner) {
  return inner ? width >= gripper.narrowest_hole() && width <= gripper.widest_hole() : width <= gripper.widest();
}

class PairFinder {
 public:
  PairFinder(const PartModel& part, const Gripper& gripper, double friction, GraspCounts& counts)
      : query_(part.query()),
        gripper_(gripper),
        least_(same_place * part.diagonal()),
        cosine_(1.0 / std::sqrt(1.0 + friction * friction)),
        counts_(counts) {}

  /// The pairs of a point with all points opposite to it through the part, and with the one across a hole.
  std::vector<Pair> from(const SpreadPoint& start) const {
    std::vector<Pair> pairs;
    for (const Passage& passage : passages(query_, start.point, -start.normal, least_)) {
      const Vec3 normal = normal_of(passage);
      if (normal.dot(start.normal) >= 0.0) continue;  // an entrance
      if (const auto pair = between(start, start.point - passage.distance * start.normal, normal, false))
        pairs.push_back(*pair);
    }
    if (!gripper_.inner) return pairs;
    const auto across = passages(query_, start.point, start.normal, least_);
    if (across.empty() || normal_of(across.front()).dot(start.normal) >= 0.0) return pairs;
    const Vec3 far = start.point + across.front().distance * start.normal;
    if (const auto pair = between(start, far, normal_of(across.front()), true)) pairs.push_back(*pair);
    return pairs;
  }

 private:
  Vec3 normal_of(const Passage& passage) const { return query_.mesh().area_vector(passage.triangle).normalized(); }

  /// The pair along the mean of both normals, for which both sides need the same friction.
  std::optional<Pair> between(const SpreadPoint& start, Vec3 far, Vec3 normal, bool inner) const {
    const double side = inner ? 1.0 : -1.0;  // of the other point, seen along the first one's normal
    Vec3 axis = start.normal;
    for (int i = 0; i < 3; ++i) {
      const Vec3 mean = (start.normal - normal).normalized();
      if ((mean - axis).norm() < 1e-9) break;
      const auto passed = passages(query_, start.point, side * mean, least_);
      const auto away = [&](const Passage& p) { return (start.point + side * p.distance * mean - far).norm(); };
      const Passage* best = nullptr;
      for (const Passage& p : passed)
        if (normal_of(p).dot(mean) < 0.0 && (!best || away(p) < away(*best))) best = &p;
      if (!best) break;
      axis = mean;
      far = start.point + side * best->distance * mean;
      normal = normal_of(*best);
    }
    if (axis.dot(start.normal) < cosine_ || -axis.dot(normal) < cosine_) {
      ++counts_.friction;
      return std::nullopt;
    }
    if (!fits(gripper_, (far - start.point).norm(), inner)) {
      ++counts_.width;
      return std::nullopt;
    }
    return Pair{start.point, far, -side * axis, inner};
  }

  const MeshQuery& query_;
  const Gripper& gripper_;
  double least_, cosine_;
  GraspCounts& counts_;
};

bool meets_part(const std::vector<Sweep>& sweeps, const MeshQuery& query, const Pose& pose) {
  const Pose part = pose.inverse();
  return std::any_of(sweeps.begin(), sweeps.end(), [&](const Sweep& sweep) { return sweep.meets(query, part); });
}

/// Contact points of both pads in the gripper's frame, whose origin is between them.
std::vector<Vec3> pad_contacts_of(const PadContact& right, const PadContact& left, double width) {
  std::vector<Vec3> points;
  for (const auto& p : right.points) points.emplace_back(0.5 * width, p.x(), p.y());
  for (const auto& p : left.points) points.emplace_back(-0.5 * width, p.x(), p.y());
  return points;
}

/// With the axis that points across the closing axis reversed.
PadContact mirrored(PadContact contact) {
  for (auto& point : contact.points) point.x() = -point.x();
  contact.centroid.x() = -contact.centroid.x();
  std::swap(contact.lower.x(), contact.upper.x());
  contact.lower.x() = -contact.lower.x();
  contact.upper.x() = -contact.upper.x();
  return contact;
}

/// Presses the pad that touches the surface on one side (1: at +x, -1: at -x).
std::optional<PressedPad> press_side(const PartModel& part, const Gripper& gripper, double friction, const Pose& pose,
                                     const Aperture& guess, double side) {
  const Mat3 frame = pose.orientation.toRotationMatrix();
  const double out = guess.inner ? -side : side;  // of the surface, along x
  Pad pad;
  pad.center = pose.position + side * 0.5 * guess.width * frame.col(0);
  pad.u = out * frame.col(1);
  pad.v = frame.col(2);
  pad.out = out * frame.col(0);
  pad.half_u = 0.5 * gripper.finger_width;
  pad.half_v = 0.5 * gripper.pad_length;
  pad.start = 0.0;
  pad.give = gripper.pad_give;
  pad.friction = friction;
  pad.start = std::max(gripper.opened(guess), same_place * part.diagonal());
  return PressedPad::on(part.query(), pad);
}

/// Along y and z of the gripper. Pads that press from +x outwards or from -x inwards count y the other way.
std::optional<PadContact> contact_of(const PressedPad& pad, bool reversed) {
  std::optional<PadContact> contact = pad.contact();
  if (contact && reversed) contact = mirrored(std::move(*contact));
  return contact;
}

}  // namespace

bool goes_through(const PartModel& part, const Gripper& gripper, const Grasp& grasp) {
  const double shrink = -10.0 * same_place * part.diagonal();
  const Aperture at = grasp.aperture();
  return meets_part(approach_sweeps(gripper, at, part.diagonal(), shrink), part.query(), grasp.pose) ||
         meets_part(closing_sweeps(gripper, at, shrink), part.query(), grasp.pose);
}

std::optional<Grasp> close_fingers(const PartModel& part, const Gripper& gripper, double friction, const Pose& pose,
                                   const Aperture& guess, GraspCounts& counts, const IsClear& is_clear) {
  const auto fail = [](std::size_t& count) {
    ++count;
    return std::nullopt;
  };
  const auto right_pad = press_side(part, gripper, friction, pose, guess, 1.0);
  const auto left_pad = right_pad ? press_side(part, gripper, friction, pose, guess, -1.0) : std::nullopt;
  if (!left_pad) return fail(counts.contact);
  const double out = guess.inner ? -1.0 : 1.0;
  const Vec3 axis = pose.orientation * Vec3::UnitX();
  Grasp grasp;
  grasp.inner = guess.inner;
  grasp.width = guess.width + out * (right_pad->height() + left_pad->height());
  grasp.pose = {pose.position + out * 0.5 * (right_pad->height() - left_pad->height()) * axis, pose.orientation};
  if (is_clear && !is_clear(grasp.pose, grasp.aperture())) return fail(counts.collision);
  const auto right = contact_of(*right_pad, guess.inner);
  const auto left = right ? contact_of(*left_pad, !guess.inner) : std::nullopt;
  if (!left) return fail(counts.contact);
  grasp.share = std::min(right->share, left->share);
  grasp.friction = std::max(right->friction, left->friction);
  grasp.radius = 0.5 * (right->radius + left->radius);
  // The forces of both pads must act along one line.
  const bool opposite =
      (right->lower.array() <= left->upper.array()).all() && (left->lower.array() <= right->upper.array()).all();
  if (!opposite || grasp.share < least_contact) return fail(counts.contact);
  if (!fits(gripper, grasp.width, grasp.inner)) return fail(counts.width);
  if (grasp.friction > friction) return fail(counts.friction);
  const Eigen::Vector2d between = 0.5 * (right->centroid + left->centroid);
  const Vec3 offset = part.mass().center - grasp.pose * Vec3(0.0, between.x(), between.y());
  grasp.lever = (offset - offset.dot(axis) * axis).norm();
  grasp.contacts = pad_contacts_of(*right, *left, grasp.width);
  const double half = 0.5 * grasp.width;
  grasp.second = {Vec3(half, right->lower.x(), right->lower.y()), Vec3(half, right->upper.x(), right->upper.y())};
  grasp.first = {Vec3(-half, left->lower.x(), left->lower.y()), Vec3(-half, left->upper.x(), left->upper.y())};
  return grasp;
}

namespace {

/// Distances of the pair of points from the pad's centre towards the tip / pad length. The last one is tried only if no
/// other one is possible, for example with long pads above a floor.
constexpr double depths[] = {0.0, 0.3, 0.42};

/// Grasps of one pair of points, approached from all sides.
ClosingAxis turn_about(const Pair& pair, const PartModel& part, const Gripper& gripper, double friction,
                       const Vec3& from, GraspCounts& counts, std::vector<Grasp>& grasps) {
  ClosingAxis axis{pose_about(pair, from, 0.0), (pair.near - pair.far).norm(), pair.inner, 0};
  for (int turn = 0; turn < ClosingAxis::turns; ++turn) {
    const Pose centred = pose_about(pair, from, 2.0 * M_PI * turn / ClosingAxis::turns);
    bool any = false;
    for (const double depth : depths) {
      if (depth == depths[2] && any) break;
      ++counts.tried;
      Pose pose = centred;
      pose.position -= depth * gripper.pad_length * (pose.orientation * Vec3::UnitZ());
      const auto grasp = close_fingers(part, gripper, friction, pose, {axis.width, axis.inner}, counts);
      if (!grasp) continue;
      if (goes_through(part, gripper, *grasp)) {
        ++counts.collision;
        continue;
      }
      ++counts.good;
      any = true;
      grasps.push_back(*grasp);
    }
    if (any) axis.approaches |= std::uint64_t{1} << turn;
  }
  return axis;
}

}  // namespace

ParallelGrasps parallel_grasps(const PartModel& part, const Gripper& gripper, double friction,
                               const std::vector<Vec3>& directions, GraspCounts& counts) {
  ParallelGrasps found;
  const PairFinder finder(part, gripper, friction, counts);
  for (const SpreadPoint& start : spread_points(part.mesh(), points_tried)) {
    stop_if_cancelled();
    for (const Pair& pair : finder.from(start)) {
      const Vec3 from = direction_across(directions, pair.axis);
      const ClosingAxis axis = turn_about(pair, part, gripper, friction, from, counts, found.grasps);
      if (axis.approaches) found.axes.push_back(axis);
    }
  }
  return found;
}

}  // namespace bin_scenes
