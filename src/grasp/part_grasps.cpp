/// Grasps of a part alone: a dense search, thinned by distance and by the symmetries of the part, and cached on disk.
#include "bin_scenes/grasp/part_grasps.hpp"

#include "grasp/directions.hpp"
#include "grasp/parallel_grasps.hpp"
#include "grasp/suction_grasps.hpp"
#include "grasp/thinning.hpp"
#include "part/part_cache.hpp"

#include <algorithm>
#include <iterator>

namespace bin_scenes {

namespace {

constexpr int grasp_format = 8;              ///< raise it whenever the search for grasps changes
constexpr double symmetry_limit = 1e-3;      ///< / diagonal: residual of symmetries that count as exact
constexpr double first_apart = 0.03;         ///< / diagonal: distance of thinning
constexpr double first_angle = 0.3;          ///< rad: angle of thinning
constexpr std::size_t left_out_one_of = 8;   ///< one of so many poses is set apart to measure coverage
constexpr double covered_within = 3.0;       ///< coverage / thinning: ratio of their distances and angles
constexpr std::size_t most_grasps = 2000;    ///< no two of which are equal by symmetry
constexpr std::size_t most_searched = 1500;  ///< closing axes, or places of a cup, for the search in a scene
constexpr double axis_angle = 0.1;           ///< rad: angle of thinning of closing axes

/// Smaller is better: the share of friction or lip that the grasp needs, and the lever of the weight.
double badness(const Grasp& grasp, const PartModel& part, const Gripper& gripper, double friction) {
  const double holding =
      gripper.type == Gripper::Type::parallel ? grasp.friction / friction - 0.5 * grasp.share : grasp.gap / gripper.lip;
  return holding + grasp.lever / part.radius();
}

std::vector<Pose> poses_of(const std::vector<Grasp>& grasps) {
  std::vector<Pose> poses;
  for (const Grasp& grasp : grasps) poses.push_back(grasp.pose);
  return poses;
}

/// Places the grasps from index `first` on; all of them are from outside, or all from within.
void place(PartGrasps& found, std::size_t first, const PoseMeasure& symmetric, const PoseMeasure::Limits& limits,
           const Gripper& gripper) {
  std::vector<PartGrasps::Placed> all;
  for (std::size_t i = first; i < found.grasps.size(); ++i)
    for (const Pose& pose : symmetric.images(found.grasps[i].pose, limits)) all.push_back({i, pose});
  std::vector<Pose> poses;
  for (const auto& placed : all) poses.push_back(placed.pose);
  const bool cup = gripper.type == Gripper::Type::suction;
  const std::size_t count = std::max(gripper.most, cup ? most_searched : 0);
  std::size_t chosen = 0;
  for (const std::size_t i : thin(poses, PoseMeasure({}, gripper.type), limits, count))
    (chosen++ < gripper.most ? found.placed : found.spare).push_back(all[i]);
}

/// The axes in all places to which symmetries move them. The first ones cover the part coarsely.
std::vector<ClosingAxis> spread_axes(std::vector<ClosingAxis> all, const PartModel& part,
                                     const Symmetries& symmetries) {
  const auto cost = [&](const ClosingAxis& axis) {
    return (axis.pose.position - part.mass().center).norm() + 0.5 * axis.width;
  };
  std::stable_sort(all.begin(), all.end(),
                   [&](const ClosingAxis& a, const ClosingAxis& b) { return cost(a) < cost(b); });
  // Distances are measured as for cups, because turns about the axis do not matter.
  const PoseMeasure symmetric(symmetries, Gripper::Type::suction), plain({}, Gripper::Type::suction);
  const PoseMeasure::Limits limits{first_apart * part.diagonal(), axis_angle};
  const Quat along_z(Eigen::AngleAxisd(0.5 * M_PI, Vec3::UnitY()));  // z of the turned frame is x of the axis
  std::vector<Pose> poses, places;
  for (const ClosingAxis& axis : all) poses.push_back({axis.pose.position, axis.pose.orientation * along_z});
  std::vector<std::size_t> of;
  for (const std::size_t i : thin(poses, symmetric, limits, most_searched))
    for (const Pose& image : symmetric.images(poses[i], limits)) {
      places.push_back(image);
      of.push_back(i);
    }
  std::vector<ClosingAxis> axes;
  std::vector<Pose> kept;
  for (const std::size_t i : thin(places, plain, limits, most_searched)) {
    const Pose reversed{places[i].position, places[i].orientation * Quat(0.0, 1.0, 0.0, 0.0)};
    const auto same = [&](const Pose& other) { return plain.near(other, reversed, limits); };
    if (std::any_of(kept.begin(), kept.end(), same)) continue;  // both directions of an axis are one
    kept.push_back(places[i]);
    axes.push_back(all[of[i]]);
    axes.back().pose = {places[i].position, (places[i].orientation * along_z.conjugate()).normalized()};
  }
  return axes;
}

std::size_t covered_of(const PartGrasps& found, const std::vector<Grasp>& left_out, const PoseMeasure& symmetric) {
  const PoseMeasure::Limits limits{found.apart, found.apart_angle};
  const auto is_covered = [&](const Grasp& one) {
    return std::any_of(found.placed.begin(), found.placed.end(), [&](const PartGrasps::Placed& placed) {
      return found.grasps[placed.of].inner == one.inner && symmetric.near(placed.pose, one.pose, limits);
    });
  };
  return static_cast<std::size_t>(std::count_if(left_out.begin(), left_out.end(), is_covered));
}

/// The grasps or closing axes from outside, or those from within. Both kinds are thinned separately, because a grasp of
/// a ring from outside may have the same pose as one from within.
template <class Kind>
std::vector<Kind> of_kind(const std::vector<Kind>& all, bool inner) {
  std::vector<Kind> chosen;
  std::copy_if(all.begin(), all.end(), std::back_inserter(chosen), [&](const Kind& one) { return one.inner == inner; });
  return chosen;
}

/// Sets some grasps apart to measure coverage, and returns the others.
std::vector<Grasp> taken_of(const std::vector<Grasp>& all, std::vector<Grasp>& left_out) {
  std::vector<Grasp> taken;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const bool apart = all.size() > left_out_one_of && i % left_out_one_of == left_out_one_of - 1;
    (apart ? left_out : taken).push_back(all[i]);
  }
  return taken;
}

}  // namespace

PartGrasps find_grasps(const PartModel& part, const Gripper& gripper, double friction) {
  PartGrasps found;
  const Symmetries symmetries = find_symmetries(part, symmetry_limit);
  ParallelGrasps all;
  if (gripper.type == Gripper::Type::parallel)
    all = parallel_grasps(part, gripper, friction, shape_directions(part, symmetries), found.counts);
  else
    all.grasps = suction_grasps(part, gripper, found.counts);
  const PoseMeasure symmetric(symmetries, gripper.type);
  const PoseMeasure::Limits limits{first_apart * part.diagonal(), first_angle};
  std::vector<Grasp> left_out;
  for (const bool inner : {false, true}) {
    std::vector<Grasp> taken = taken_of(of_kind(all.grasps, inner), left_out);
    std::stable_sort(taken.begin(), taken.end(), [&](const Grasp& a, const Grasp& b) {
      return badness(a, part, gripper, friction) < badness(b, part, gripper, friction);
    });
    const std::size_t first = found.grasps.size();
    for (const std::size_t i : thin(poses_of(taken), symmetric, limits, most_grasps)) found.grasps.push_back(taken[i]);
    place(found, first, symmetric, limits, gripper);
    for (ClosingAxis& axis : spread_axes(of_kind(all.axes, inner), part, symmetries)) found.axes.push_back(axis);
  }
  found.apart = covered_within * limits.apart;
  found.apart_angle = covered_within * limits.angle;
  found.coverage =
      static_cast<double>(covered_of(found, left_out, symmetric)) / static_cast<double>(left_out.size() + 2);
  return found;
}

template <class Stream>
void members(Stream& stream, Aabb& box) {
  stream(box.lower, box.upper);
}

template <class Stream>
void members(Stream& stream, Grasp& g) {
  stream(g.pose, g.width, g.share, g.friction, g.radius, g.lever, g.gap, g.margin, g.inner, g.first, g.second,
         g.contacts);
}

template <class Stream>
void members(Stream& stream, PartGrasps::Placed& placed) {
  stream(placed.of, placed.pose);
}

template <class Stream>
void members(Stream& stream, ClosingAxis& axis) {
  stream(axis.pose, axis.width, axis.inner, axis.approaches);
}

template <class Stream>
void members(Stream& stream, GraspCounts& n) {
  stream(n.tried, n.width, n.friction, n.contact, n.seal, n.collision, n.good);
}

template <class Stream>
void members(Stream& stream, PartGrasps& found) {
  stream(found.grasps, found.placed, found.spare, found.axes, found.counts, found.coverage, found.apart,
         found.apart_angle);
  const std::size_t last = std::max<std::size_t>(found.grasps.size(), 1) - 1;
  for (auto* placed : {&found.placed, &found.spare})
    for (PartGrasps::Placed& one : *placed) one.of = std::min(one.of, last);  // as read from a damaged file
}

std::string grasp_key(const PartModel& part, const Gripper& g, double friction) {
  std::string key = part.mesh_key() + " grasps " + std::to_string(grasp_format) + " " +
                    std::to_string(static_cast<int>(g.type)) + " " + std::to_string(g.most) + " ";
  for (const double value :
       {g.travel(), g.opening, g.finger_width, g.finger_depth, g.finger_thickness, g.pad_length, g.pad_give, g.radius,
        g.lip, g.margin, g.finger_clearance, g.palm.x(), g.palm.y(), g.palm.z(), g.tool_rotation.x(),
        g.tool_rotation.y(), g.tool_rotation.z(), g.inner ? 1.0 : 0.0, friction})
    key += key_text(value);
  for (const Aabb& box : g.finger_boxes)
    for (int i = 0; i < 3; ++i) key += key_text(box.lower[i]) + key_text(box.upper[i]);
  return key;
}

PartGrasps part_grasps(const PartModel& part, const Gripper& gripper, double friction) {
  return cached<PartGrasps>("grasps", grasp_key(part, gripper, friction),
                            [&] { return find_grasps(part, gripper, friction); });
}

std::string text_of(const GraspCounts& c, Gripper::Type type) {
  std::string text = std::to_string(c.tried) + " poses tried";
  const auto add = [&](std::size_t count, const char* why) {
    if (count > 0) text += ", " + std::to_string(count) + " " + why;
  };
  add(c.width, "wider than the stroke");
  add(c.friction, "that friction does not hold");
  add(c.contact, type == Gripper::Type::parallel ? "where the pads do not meet"
                                                 : "where the ring leaves the part, or comes too near an edge");
  add(c.seal, "that do not seal");
  add(c.collision, "where the gripper meets the part");
  return text;
}

}  // namespace bin_scenes
