/// What can be picked of a finished scene: free grasps of each part, what hinders its lift, and an order of removal.
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

/// What the score of a grasp is made from. Each is 0..1, the larger the better, but for the factors of safety.
struct GraspColumns {
  double safety = 0.0;     ///< factor by which the burden of the lift could grow before the part slips or turns
  double sliding = 0.0;    ///< the same before the part slides out, whatever it turns in the gripper
  double antipodal = 0.0;  ///< share of friction that the slope of the contacts leaves; of a lip that its gap leaves
  double moment = 0.0;     ///< 1 - sqrt(moment of the weight about the contact / moment that is held)
  double overlap = 0.0;    ///< fingers: 1 - exp(-(share of the pad in contact) / 0.05); cup: margin / (radius / 2)
  double upright = 0.0;    ///< 1 - tilt / 90 degrees
  double clearance =
      0.0;  ///< of free grasps: 0.5 where twice the clearance is free beside the gripper, 1 where four times
  double closing = 0.0;   ///< fingers: 1 - width / stroke; cup: 1
  double seen = 1.0;      ///< share of the contact that the best camera sees; 1 without images
  double measured = 1.0;  ///< share of the contact that the best camera measured; 1 without images
};

/// `use(name, value)` for each column.
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
  int part = 0;             ///< id
  std::size_t gripper = 0;  ///< index into Request::grippers
  /// Index into PartGrasps::grasps: equal for grasps that symmetries make alike. None: fingers, found in the scene.
  std::optional<std::size_t> grasp;
  Pose pose;           ///< of the gripper in the bin frame
  double width = 0.0;  ///< m, parallel
  bool inner = false;  ///< parallel: the fingers press outwards, from within
  double force = 0.0;  ///< N: of each finger; of the vacuum, less what the lip takes in its gap
  double score = 0.0;  ///< 0..1: of the columns, by the gripper's weights; calibrated as the chance of the lift
  GraspColumns columns;
  double friction = 0.0;  ///< smallest coefficient with which it lifts the part out; infinite: none suffices
  /// Why it is not free. Sweeps are those of the gripper grown by its clearance; of what it touches, one is named.
  enum class Obstacle {
    none,      ///< it is free
    blocked,   ///< others hinder the part's lift: PartPick::blocked_by
    slips,     ///< it cannot hold what the part, its load and its neighbours' friction weigh
    approach,  ///< while it moves in from outside the bin
    closing,   ///< as its fingers close
    lift       ///< as it goes up with the part
  } obstacle = Obstacle::none;
  int other = -1;  ///< approach, closing, lift: id of the part that it meets, -1: the bin

  Aperture aperture() const { return {width, inner}; }

  /// By sensor, in the order of the images: shares of the contact that the camera sees, and that it measured.
  std::vector<double> visible, measured;
  std::optional<LiftProof> proof;  ///< of those that Request::prove chose
  bool free() const { return obstacle == Obstacle::none; }
};

/// A scene's own search for grasps of a part.
struct PartSearch {
  std::size_t gripper = 0;  ///< index into Request::grippers
  std::size_t tried = 0;    ///< poses
  std::size_t free = 0;
  double least_tilt = std::numeric_limits<double>::infinity();  ///< rad: of the approaches tried
};

/// A part that could be picked.
struct PartPick {
  int id = 0;
  double load = 0.0;            ///< N: what others press down on it; 0 also if the solver reports no forces
  double pull = 0.0;            ///< N to lift it out: its weight, the load, and friction of contacts at its sides
  Vec3 lift = Vec3::Zero();     ///< m, bin frame: the displacement by which it leaves all others below it; straight up
                                ///< if that is free or nothing is, else the free direction nearest to it that was found
  std::vector<int> blocked_by;  ///< ids that obstruct its lift or lie on it, ascending; -1: a bin's mesh
  /// Whether those only cover it so little that its grasps are looked for all the same: Request::slight_overlap.
  bool slight = false;
  bool lifts() const { return blocked_by.empty() || slight; }
  /// By how much those of `blocked_by` that are parts cover it, seen along the lift.
  struct Overlap {
    double area = 0.0;         ///< m2
    double share = 0.0;        ///< of the part's footprint
    Vec3 move = Vec3::Zero();  ///< m across the lift: the shortest that was found after which nothing is above it
    bool passes = false;       ///< whether the part meets nothing on this move but what it lies on or grazes
  } overlap;
  std::vector<double> blocked_areas;  ///< m2, of each one of blocked_by alone
  int depth = -1;          ///< how many rounds of picking precede it; -1: never, as of what a fixed part covers
  std::size_t tilted = 0;  ///< grasps left out because their approach is tilted too far
  std::vector<PartSearch> searches;  ///< by gripper, of parts that nothing blocks
};

struct SceneGrasps {
  std::vector<SceneGrasp> grasps;  ///< by part, then gripper; those within the grippers' tilt
  std::vector<PartPick> parts;     ///< in the order of the scene
  /// All ids, each after all that block it but for sets of parts that hold each other; the highest first. Parts with
  /// depth -1 come last.
  std::vector<int> removal_order;
  /// Parts that hold each other, and therefore leave together.
  struct HeldSet {
    std::vector<int> ids;    ///< in the order of removal
    int part = -1, by = -1;  ///< the one that is covered the least by another one of the set
    double overlap = 0.0;    ///< m2
  };
  std::vector<HeldSet> held_sets;
  /// Of each part line and gripper.
  struct Found {
    std::size_t line = 0, gripper = 0;
    std::size_t grasps = 0;  ///< that no symmetry makes alike
    std::size_t placed = 0;  ///< of a part that scenes try
    double coverage = 0.0;
    GraspCounts counts;
  };
  std::vector<Found> found;
};

const char* name_of(SceneGrasp::Obstacle obstacle);
/// "meets part 7 on its approach"; empty: free.
std::string reason_of(const SceneGrasp& grasp, const PartPick& part);
/// Remarks on parts for which a gripper has no grasp at all: why, and how many poses each.
std::vector<Flag> flags_of(const SceneGrasps& grasps, const Request& request);

/// Keeps the grasps of parts between scenes. Thread-safe.
class Grasper {
 public:
  Grasper();
  ~Grasper();
  /// For all grippers of the request and all parts that are there and not fixed. Lifts go against gravity.
  SceneGrasps find(const Scene& scene, const LoadedRequest& loaded, const std::vector<RangeImage>& images) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace bin_scenes
