/// Grasps in a finished scene: the free grasps of each part, the parts that obstruct its lift, and an order of removal.
/// Generator computes it on demand; files, the node and the Python module only convert it. part_grasps.hpp has the
/// grasps of a part alone.
#pragma once

#include "bin_scenes/grasp/part_grasps.hpp"
#include "bin_scenes/part/loaded_request.hpp"
#include "bin_scenes/scene/lift_proof.hpp"
#include "bin_scenes/scene/scene.hpp"
#include "bin_scenes/sensor/range_image.hpp"

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace bin_scenes {

/// The quantities from which the score of a grasp is computed; larger is better. Columns other than the safety factors
/// are in 0..1.
struct GraspColumns {
  double safety = 0.0;     ///< factor by which the load of the lift could grow before the part slips or turns
  double sliding = 0.0;    ///< the same before the part slides out of the gripper; rotation is allowed
  double antipodal = 0.0;  ///< fingers: 1 - friction needed at the contacts / friction; cup: 1 - gap / lip
  double moment = 0.0;     ///< 1 - sqrt(moment of the weight about the contact / moment that the grasp can hold)
  double overlap = 0.0;    ///< fingers: 1 - exp(-(share of the pad in contact) / 0.05); cup: margin / (radius / 2)
  double upright = 0.0;    ///< 1 - tilt / 90 degrees
  /// Free grasps only: 0.5 if twice the clearance is free beside the gripper, 1 if four times the clearance is free.
  double clearance = 0.0;
  double closing = 0.0;   ///< fingers: 1 - width / stroke; cup: 1
  double seen = 1.0;      ///< share of the contact that the best camera sees; 1 without images
  double measured = 1.0;  ///< share of the contact that the best camera measured; 1 without images
};

/// Calls use(name, value) for each column.
template <class Use>
void for_each_column(const GraspColumns& c, const Use& use) {
  use("safety", c.safety);
  use("sliding", c.sliding);
  use("antipodal", c.antipodal);
  use("moment", c.moment);
  use("overlap", c.overlap);
  use("upright", c.upright);
  use("clearance", c.clearance);
  use("closing", c.closing);
  use("seen", c.seen);
  use("measured", c.measured);
}

struct SceneGrasp {
  int part = 0;             ///< id of the part
  std::size_t gripper = 0;  ///< index into Request::grippers
  /// Index into PartGrasps::grasps; grasps that are equal by symmetry share it. None: found by the search in the scene.
  std::optional<std::size_t> grasp;
  Pose pose;           ///< pose of the gripper frame in the bin frame
  double width = 0.0;  ///< parallel: distance of the surfaces that the pads touch (m)
  bool inner = false;  ///< parallel: whether the fingers are in a hole and press outwards
  double force = 0.0;  ///< N: of each finger; of the vacuum after the loss by the gap under the lip
  double score = 0.0;  ///< 0..1: estimated chance that the lift succeeds, from the columns and the gripper's weights
  GraspColumns columns;
  double friction = 0.0;  ///< smallest friction coefficient at which it lifts the part; infinite: none is enough
  /// Reason why the grasp is not free. Collisions are those of the gripper, enlarged by its clearance on all sides.
  enum class Obstacle {
    none,      ///< the grasp is free
    blocked,   ///< other parts obstruct the lift of the part: PartPick::blocked_by
    slips,     ///< the grasp cannot hold weight, load, inertia and the friction at the neighbours
    approach,  ///< the gripper collides while it moves in from outside the bin
    closing,   ///< the fingers collide while they close
    lift       ///< the gripper collides while it moves out with the part
  } obstacle = Obstacle::none;
  int other = -1;  ///< for approach, closing, lift: id of the first part that the gripper hits; -1: the bin

  Aperture aperture() const { return {width, inner}; }

  /// For each image: the shares of the contact points that the camera sees, and for which it measured a depth.
  std::vector<double> visible, measured;
  std::optional<LiftProof> proof;  ///< result of a simulated lift, for the grasps that Request::prove chose
  bool free() const { return obstacle == Obstacle::none; }
};

/// Result of the search for grasps of a part in the scene (Gripper::free_wanted).
struct PartSearch {
  std::size_t gripper = 0;                                      ///< index into Request::grippers
  std::size_t tried = 0;                                        ///< number of poses that were tried
  std::size_t free = 0;                                         ///< number of free grasps that were found
  double least_tilt = std::numeric_limits<double>::infinity();  ///< rad: smallest tilt of an approach that was tried
};

/// The lift of one part: the forces that it needs, and the parts that obstruct it.
struct PartPick {
  int id = 0;
  double load = 0.0;            ///< N: force of other parts downwards; 0 also if the solver reports no forces
  double pull = 0.0;            ///< force (N) to lift it out: weight, load, and friction at the contacts on its sides
  Vec3 lift = Vec3::Zero();     ///< m, bin frame: displacement that moves it above all other parts. Straight up, unless
                                ///< only another direction within Request::lift_cone is free
  std::vector<int> blocked_by;  ///< ids of parts that obstruct the lift or lie on the part, ascending; -1: a bin's mesh
  /// Whether these parts cover so little of the part (Request::slight_overlap) that its grasps are tried nevertheless.
  bool slight = false;
  bool lifts() const { return blocked_by.empty() || slight; }
  /// How much the parts in `blocked_by` cover the part, in a projection along gravity.
  struct Overlap {
    double area = 0.0;         ///< covered area (m2)
    double share = 0.0;        ///< covered area / footprint of the part
    Vec3 move = Vec3::Zero();  ///< m, horizontal: the shortest move found after which these parts do not cover it
    bool passes = false;       ///< whether the part meets no other part on this move; it may slide on its support
  } overlap;
  std::vector<double> blocked_areas;  ///< area (m2) that each part of blocked_by covers
  int depth = -1;          ///< number of rounds of picking before it can be lifted; -1: never, below something fixed
  std::size_t tilted = 0;  ///< number of grasps left out because their approach is tilted by more than Gripper::tilt
  std::vector<PartSearch> searches;  ///< one for each gripper, if the part can be lifted
};

struct SceneGrasps {
  std::vector<SceneGrasp> grasps;  ///< sorted by part, then by gripper, then by score, the best first
  std::vector<PartPick> parts;     ///< in the order of the scene
  /// The ids of all parts. Each part comes after the parts that block it, except within a set of `held_sets`. Of
  /// several parts that nothing blocks, the highest one comes first; parts that can never be lifted come last.
  std::vector<int> removal_order;
  /// A part that is lifted although others of its set still cover it.
  struct Forced {
    int part = -1;
    double overlap = 0.0;  ///< area (m2) of the part that they cover
  };
  /// Parts that block each other in a circle. Two parts are lifted together. Of a larger set, the part that the others
  /// cover least is lifted first, although they cover it; then those that this frees, and so on.
  struct HeldSet {
    std::vector<int> ids;        ///< ids of the set, in the order of removal
    std::vector<Forced> forced;  ///< for a set of more than two parts: the forced lifts, in the order of removal
    int part = -1, by = -1;      ///< pair with the smallest overlap: `by` covers `part`
    double overlap = 0.0;        ///< overlap of that pair (m2)
  };
  std::vector<HeldSet> held_sets;
  /// Result of the search for grasps of a part alone, for one part line and one gripper.
  struct Found {
    std::size_t line = 0, gripper = 0;  ///< indices into Request::parts and Request::grippers
    std::size_t grasps = 0;             ///< number of grasps (PartGrasps::grasps)
    std::size_t placed = 0;             ///< number of poses (PartGrasps::placed)
    double coverage = 0.0;              ///< PartGrasps::coverage
    GraspCounts counts;
  };
  std::vector<Found> found;
};

const char* name_of(SceneGrasp::Obstacle obstacle);
/// Returns the reason why a grasp is not free, such as "gripper meets part 7: approach"; empty if it is free.
std::string reason_of(const SceneGrasp& grasp, const PartPick& part);
/// Returns flags for grippers that have no grasp of a part at all, with the reasons, and for palms that do not fit into
/// the bin.
std::vector<Flag> flags_of(const SceneGrasps& grasps, const Request& request);

/// Finds grasps in scenes, and keeps the grasps of the parts between scenes. May be used by several threads.
class Grasper {
 public:
  Grasper();
  ~Grasper();
  /// Returns the grasps of all parts that are in the scene and are not fixed, for all grippers of the request.
  /// @param images  images of the scene, by sensor; empty: no grasp counts as seen or measured
  SceneGrasps find(const Scene& scene, const LoadedRequest& loaded, const std::vector<RangeImage>& images) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace bin_scenes
