/// Grasps of a part alone by one gripper: poses in which two pads touch the part from opposite sides, or in which the
/// ring of a cup seals. They are found once for each mesh and gripper, and kept in the disk cache.
#pragma once

#include "bin_scenes/part/part_model.hpp"
#include "bin_scenes/scene/gripper.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace bin_scenes {

/// A grasp: a pose of the gripper, and the quantities that decide whether the gripper holds the part.
struct Grasp {
  Pose pose;                   ///< pose of the gripper frame (scene/gripper.hpp) in the model frame
  double width = 0.0;          ///< parallel: distance of the surfaces that the pads touch (m)
  bool inner = false;          ///< parallel: whether the fingers are in a hole and press outwards
  double share = 1.0;          ///< parallel: share of a pad that touches the part; the smaller of both pads
  double friction = 0.0;       ///< smallest friction coefficient at which the grasp holds without load
  double radius = 0.0;         ///< m. parallel: largest moment about the closing axis / (2 * friction * force);
                               ///< suction: radius of the ring
  double lever = 0.0;          ///< m: distance of the centre of mass from the closing axis, or from the cup's axis
  double margin = 0.0;         ///< m, suction: distance of the ring from edges and holes, at most half the radius
  Aabb first, second;          ///< parallel: bounds of the contact on the pad at -x and at +x (m, gripper's frame)
  double gap = 0.0;            ///< m, suction: largest distance of the pressed and tilted ring from the surface
  std::vector<Vec3> contacts;  ///< points of the surface that the pads or the ring touch (m, gripper's frame)
  Aperture aperture() const { return {width, inner}; }
};

/// Number of poses that were tried, and how many of them were rejected for each reason.
struct GraspCounts {
  std::size_t tried = 0;      ///< number of poses that were tried
  std::size_t width = 0;      ///< parallel: the fingers cannot open to this width
  std::size_t friction = 0;   ///< at least one surface is too steep for the friction
  std::size_t contact = 0;    ///< parallel: pads do not touch opposite surfaces; suction: ring reaches beyond an edge
  std::size_t seal = 0;       ///< suction: the gap is wider than the lip can close, or the surface is too steep
  std::size_t collision = 0;  ///< the gripper collides with the part
  std::size_t good = 0;       ///< poses that were not rejected
};

/// A line along which two pads can close on a part, from outside or on the walls of a hole. The search for grasps in a
/// scene (Gripper::free_wanted) tries further approaches and depths on it.
struct ClosingAxis {
  static constexpr int turns = 16;  ///< number of approach directions around the line that were tried
  Pose pose;                        ///< origin: centre between both surfaces; x: along the line; z: approach at turn 0
  double width = 0.0;               ///< distance between the surfaces (m)
  bool inner = false;               ///< whether the surfaces are walls of a hole
  std::uint64_t approaches = 0;     ///< bit k: at turn k the gripper holds the part and does not collide with it
};

/// All grasps of a part by one gripper. Grasps and their order do not depend on Gripper::most, which limits `placed`.
struct PartGrasps {
  std::vector<Grasp> grasps;  ///< thinned grasps; no two of them are equal by a symmetry of the part
  /// The poses that scenes try: each grasp in all places to which symmetries of the part move it, thinned again. The
  /// first ones cover the part coarsely, later ones fill the space between them.
  struct Placed {
    std::size_t of = 0;  ///< index into grasps
    Pose pose;           ///< pose of the gripper frame in the model frame
  };
  std::vector<Placed> placed;     ///< poses that are tried in every scene
  std::vector<Placed> spare;      ///< suction: further poses for the search in a scene
  std::vector<ClosingAxis> axes;  ///< parallel: for the search in a scene; the first ones cover the part coarsely
  GraspCounts counts;
  /// How completely `placed` represents all grasps of the part. Of n good poses that were set apart before thinning,
  /// c have a placed grasp within both distances below, symmetries included; the coverage is c / (n + 2), and is
  /// therefore clearly below 1 if few poses were tried.
  double coverage = 0.0;
  double apart = 0.0;        ///< distance of positions in `coverage` (m)
  double apart_angle = 0.0;  ///< angle between orientations in `coverage` (rad)
};

/// Finds the grasps of a part. The same arguments give the same result.
/// @param friction  friction coefficient between gripper and part
PartGrasps find_grasps(const PartModel& part, const Gripper& gripper, double friction);
/// Returns a key made of mesh, gripper and friction. If two keys are equal, the grasps are equal.
std::string grasp_key(const PartModel& part, const Gripper& gripper, double friction);
/// Returns the result of find_grasps(), from the disk cache if it contains the result.
PartGrasps part_grasps(const PartModel& part, const Gripper& gripper, double friction);

/// Returns the numbers of rejected poses and the reasons, such as "5000 poses tried, 120 that do not seal".
std::string text_of(const GraspCounts& counts, Gripper::Type type);

}  // namespace bin_scenes
