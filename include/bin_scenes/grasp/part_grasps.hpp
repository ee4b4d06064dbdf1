/// Grasps of a part by a gripper, found once a content: where two pads meet the part from opposite sides, or a cup's
/// ring seals.
#pragma once

#include "bin_scenes/part/part_model.hpp"
#include "bin_scenes/scene/gripper.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace bin_scenes {

/// Pose and what decides whether it holds. Model frame of the part, m.
struct Grasp {
  Pose pose;                   ///< of the gripper's frame (scene/gripper.hpp) in the model frame
  double width = 0.0;          ///< parallel: distance of the surfaces that the pads touch (m)
  bool inner = false;          ///< parallel: the fingers press outwards, from within
  double share = 1.0;          ///< parallel: of the pad that is in contact, the smaller of both
  double friction = 0.0;       ///< smallest coefficient with which it holds without load
  double radius = 0.0;         ///< m. parallel: largest moment about the closing axis = 2 * friction * force * radius;
                               ///< suction: of the ring
  double lever = 0.0;          ///< m of the centre of mass from closing axis, or from the cup's axis
  double margin = 0.0;         ///< m, suction: distance of the ring from edges and holes, as far as it was looked for
  Aabb first, second;          ///< parallel: of the contact on the pad at -x and at x (m, gripper's frame)
  double gap = 0.0;            ///< m, suction: largest distance of the ring, pressed on and tilted, from the surface
  std::vector<Vec3> contacts;  ///< points of the surface that the pads or the ring touch; gripper's frame
  Aperture aperture() const { return {width, inner}; }
};

/// How many poses were tried, and what became of them.
struct GraspCounts {
  std::size_t tried = 0;
  std::size_t width = 0;      ///< wider than the stroke
  std::size_t friction = 0;   ///< steeper than friction holds, on one side at least
  std::size_t contact = 0;    ///< the pads do not meet opposite each other; the ring leaves the part
  std::size_t seal = 0;       ///< the gap is wider than the lip closes, or the surface too tilted
  std::size_t collision = 0;  ///< the gripper would go through the part
  std::size_t good = 0;       ///< the rest
};

/// A line on which two pads can close, through the part or from wall to wall of a hole: where a scene looks for further
/// grasps. Model frame.
struct ClosingAxis {
  static constexpr int turns = 16;  ///< steps in which the turn of the approach about the direction is counted
  Pose pose;                        ///< between the surfaces; x along the direction, z the approach of turn 0
  double width = 0.0;               ///< m between the surfaces
  bool inner = false;               ///< the surfaces face each other, with nothing between them
  std::uint64_t approaches = 0;     ///< bit k: at turn k the gripper holds the part, without going through it
};

/// Neither grasps nor their order depend on Gripper::most, which only ends the list of placed ones.
struct PartGrasps {
  std::vector<Grasp> grasps;  ///< thinned; none is another one turned by a symmetry of the part
  /// Where scenes try them: each grasp in all places to which symmetries of the part bring it, thinned again, a coarse
  /// cover of the part first.
  struct Placed {
    std::size_t of = 0;  ///< index into grasps
    Pose pose;           ///< of the gripper in the model frame
  };
  std::vector<Placed> placed;     ///< those that every scene tries
  std::vector<Placed> spare;      ///< suction: those after them, for a scene's own search
  std::vector<ClosingAxis> axes;  ///< parallel: for a scene's own search, a coarse cover of the part first
  GraspCounts counts;
  /// Share of good poses left out of thinning that have a placed grasp, or one that symmetries make alike, within the
  /// distances. Of n such poses covered / (n + 2), which stays below 1 where few poses were tried.
  double coverage = 0.0;
  double apart = 0.0;        ///< m
  double apart_angle = 0.0;  ///< rad
};

/// Deterministic. @param friction  coefficient of gripper and part
PartGrasps find_grasps(const PartModel& part, const Gripper& gripper, double friction);
/// Of mesh, gripper and friction: equal keys, equal grasps.
std::string grasp_key(const PartModel& part, const Gripper& gripper, double friction);
/// The same through the disk cache.
PartGrasps part_grasps(const PartModel& part, const Gripper& gripper, double friction);

/// "5000 poses tried, 120 that do not seal": how many failed, and why.
std::string text_of(const GraspCounts& counts, Gripper::Type type);

}  // namespace bin_scenes
