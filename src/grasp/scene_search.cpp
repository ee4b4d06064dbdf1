/// Candidates are sorted into bands by tilt. Of each band, a first chunk that covers the part coarsely is tried, in the
/// order of cost; after the last band, the second chunk of each band follows, and so on.
#include "grasp/scene_search.hpp"

#include "bin_scenes/core/cancel.hpp"
#include "grasp/gripper_shape.hpp"
#include "grasp/parallel_grasps.hpp"
#include "grasp/thinning.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace bin_scenes {

namespace {

constexpr double band_width = 0.175;     ///< rad
constexpr std::size_t chunk = 40;        ///< candidates of a band
constexpr double turn_step = 0.262;      ///< rad, about the closing axis
constexpr int most_turns = 3;            ///< to either side
constexpr double levelled_up_to = 0.2;   ///< rad: closing axes with a smaller slope are also tried horizontally
constexpr double level = 0.005;          ///< rad: closing axes with a smaller slope count as horizontal
constexpr double depth_step = 0.15;      ///< of the pad's length
constexpr double least_hold = 0.45;      ///< of the pad's length: largest distance of the axis from the pad's centre
constexpr double alike_distance = 0.06;  ///< / diagonal: distance of free grasps that count as similar
constexpr double alike_angle = 0.25;     ///< rad: and their angle
constexpr double width_cost = 0.5;       ///< weight of width / stroke in the cost; tilt and lever / radius have 1

struct Candidate {
  Pose pose;          ///< of the gripper in the bin frame
  double tilt = 0.0;  ///< rad
  double cost = 0.0;  ///< order within a chunk
  Aperture guess;     ///< at the closing axis, before the pads are pressed on
  std::size_t index = 0;
};

/// Coarse chunks of all bands, then finer ones.
std::vector<Candidate> ordered(const std::vector<Candidate>& all) {
  std::vector<std::size_t> in_band;
  std::vector<std::pair<std::array<std::size_t, 2>, std::size_t>> keys;  // chunk and band, index
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto band = static_cast<std::size_t>(all[i].tilt / band_width);
    in_band.resize(std::max(in_band.size(), band + 1));
    keys.push_back({{in_band[band]++ / chunk, band}, i});
  }
  std::sort(keys.begin(), keys.end(), [&](const auto& a, const auto& b) {
    if (a.first != b.first) return a.first < b.first;
    if (all[a.second].cost != all[b.second].cost) return all[a.second].cost < all[b.second].cost;
    return a.second < b.second;
  });
  std::vector<Candidate> result;
  for (const auto& key : keys) result.push_back(all[key.second]);
  return result;
}

double tilt_of(const Vec3& approach, const Vec3& up) {
  return std::acos(std::clamp(-approach.dot(up), -1.0, 1.0));
}

class Searcher {
 public:
  Searcher(const SearchedPart& searched, const IsReached& is_reached, const KeepIfFree& keep)
      : s_(searched),
        is_reached_(is_reached),
        keep_(keep),
        measure_({}, searched.gripper.type),
        limits_{alike_distance * searched.model.diagonal(), alike_angle} {}

  PartSearch with_fingers() {
    for (const Candidate& candidate : ordered(finger_candidates())) {
      if (over()) break;
      if (!is_new(candidate)) continue;
      stop_if_cancelled();
      try_depths(candidate);
    }
    return result_;
  }

  PartSearch with_cup() {
    const std::size_t listed = s_.grasps.placed.size();
    for (const Candidate& candidate : ordered(cup_candidates())) {
      if (over()) break;
      if (!is_new(candidate)) continue;
      stop_if_cancelled();
      const std::size_t of = place(candidate.index).of;
      note({s_.grasps.grasps[of], candidate.pose, of, candidate.index < listed}, candidate.tilt);
    }
    return result_;
  }

 private:
  bool over() const { return result_.free >= s_.gripper.free_wanted || result_.tried >= s_.gripper.tries; }

  bool is_new(const Candidate& candidate) const {
    return std::none_of(found_.begin(), found_.end(), [&](const Found& known) {
      return known.inner == candidate.guess.inner && measure_.near(known.pose, candidate.pose, limits_);
    });
  }

  bool note(const SearchedPose& tried, double tilt) {
    count(tilt);
    if (!keep_(tried)) return false;
    ++result_.free;
    found_.push_back({tried.pose, tried.grasp.inner});
    return true;
  }
  void count(double tilt) {
    ++result_.tried;
    result_.least_tilt = std::min(result_.least_tilt, tilt);
  }

  /// Horizontal distance of the centre of mass from a point / radius of the part.
  double lever(const Vec3& point) const {
    const Vec3 &up = s_.placed.up(), offset = s_.part.pose * s_.model.mass().center - point;
    return (offset - offset.dot(up) * up).norm() / s_.model.radius();
  }

  /// Whether the gripper did not collide with the part itself at one of the nearest turns that were tried.
  bool leaves_room(const ClosingAxis& axis, const Vec3& approach) const {
    const Vec3 local = (s_.part.pose.orientation * axis.pose.orientation).conjugate() * approach;
    const double turn = std::atan2(-local.y(), local.z()) / (2.0 * M_PI) * ClosingAxis::turns;
    const auto nearest = static_cast<int>(std::lround(turn)) + ClosingAxis::turns;
    for (const int k : {nearest - 1, nearest, nearest + 1})
      if (axis.approaches >> (k % ClosingAxis::turns) & 1) return true;
    return false;
  }

  void add(std::vector<Candidate>& all, const Vec3& center, const Vec3& axis, const ClosingAxis& of) const {
    const Vec3& up = s_.placed.up();
    const Vec3 steepest = axis.dot(up) * axis - up;
    if (!(steepest.norm() > 1e-3)) return;
    for (int turn = -most_turns; turn <= most_turns; ++turn) {
      const Vec3 z = Eigen::AngleAxisd(turn * turn_step, axis) * steepest.normalized();
      const double tilt = tilt_of(z, up);
      if (tilt > s_.gripper.tilt || !leaves_room(of, z)) continue;
      Mat3 frame;
      frame << axis, z.cross(axis), z;
      const Aperture guess{of.width, of.inner};
      const double cost = tilt + lever(center) + width_cost * s_.gripper.between_fingers(guess) / s_.gripper.travel();
      all.push_back({{center, Quat(frame).normalized()}, tilt, cost, guess, 0});
    }
  }

  std::vector<Candidate> finger_candidates() const {
    std::vector<Candidate> all;
    const Vec3& up = s_.placed.up();
    for (const ClosingAxis& one : s_.grasps.axes) {
      const Pose pose = s_.part.pose * one.pose;
      const Vec3 &center = pose.position, axis = pose.orientation * Vec3::UnitX();
      const double slope = std::asin(std::clamp(std::abs(axis.dot(up)), 0.0, 1.0));
      if (slope > s_.gripper.tilt) continue;
      add(all, center, axis, one);
      if (slope > level && slope < levelled_up_to) add(all, center, (axis - axis.dot(up) * up).normalized(), one);
    }
    return all;
  }

  const PartGrasps::Placed& place(std::size_t index) const {
    const std::size_t listed = s_.grasps.placed.size();
    return index < listed ? s_.grasps.placed[index] : s_.grasps.spare[index - listed];
  }

  std::vector<Candidate> cup_candidates() const {
    std::vector<Candidate> all;
    for (std::size_t i = 0; i < s_.grasps.placed.size() + s_.grasps.spare.size(); ++i) {
      const PartGrasps::Placed& one = place(i);
      const Pose pose = s_.part.pose * one.pose;
      const double tilt = tilt_of(pose.orientation * Vec3::UnitZ(), s_.placed.up());
      if (tilt <= s_.gripper.tilt) all.push_back({pose, tilt, tilt + lever(pose.position), {}, i});
    }
    return all;
  }

  /// Distance (m) by which the gripper has to move back along its approach so that it does not touch the floor.
  double above_floor(const Candidate& candidate) const {
    if (!s_.placed.flat_floor()) return 0.0;
    const double down = -(candidate.pose.orientation * Vec3::UnitZ()).z();
    double lowest = std::numeric_limits<double>::infinity();
    for (const Sweep& body : approach_sweeps(s_.gripper, candidate.guess, 0.0, s_.gripper.clearance))
      lowest = std::min(lowest, body.placed(candidate.pose).lowest(Vec3::UnitZ()));
    constexpr double rounding = 1e-6;
    return down > 0.05 ? std::max(0.0, rounding - lowest) / down : 0.0;
  }

  /// Tries the closing axis at the pad's centre, or as near to it as the floor permits, and then nearer to the tip.
  void try_depths(const Candidate& candidate) {
    const double length = s_.gripper.pad_length;
    const Pose into_part = s_.part.pose.inverse();
    const IsClear is_clear = [&](const Pose& pose, const Aperture& at) { return is_reached_(s_.part.pose * pose, at); };
    GraspCounts counts;
    double back = above_floor(candidate);
    if (back > least_hold * length) return count(candidate.tilt);
    for (; back <= least_hold * length && !over(); back += depth_step * length) {
      Pose pose = candidate.pose;
      pose.position -= back * (pose.orientation * Vec3::UnitZ());
      const auto grasp =
          close_fingers(s_.model, s_.gripper, s_.friction, into_part * pose, candidate.guess, counts, is_clear);
      if (!grasp) {
        count(candidate.tilt);
        continue;
      }
      if (note({*grasp, s_.part.pose * grasp->pose, 0, false}, candidate.tilt)) return;
    }
  }

  const SearchedPart& s_;
  const IsReached& is_reached_;
  const KeepIfFree& keep_;
  PoseMeasure measure_;
  PoseMeasure::Limits limits_;
  struct Found {
    Pose pose;
    bool inner;
  };
  std::vector<Found> found_;
  PartSearch result_;
};

}  // namespace

PartSearch search_scene(const SearchedPart& searched, const IsReached& is_reached, const KeepIfFree& keep) {
  Searcher searcher(searched, is_reached, keep);
  return searched.gripper.type == Gripper::Type::parallel ? searcher.with_fingers() : searcher.with_cup();
}

}  // namespace bin_scenes
