/// The grasps of each part are moved to the pose of the part in the scene and tested, the cheapest test first: tilt,
/// blocking parts, holding, collisions.
#include "bin_scenes/grasp/scene_grasps.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/core/cancel.hpp"
#include "bin_scenes/core/contact.hpp"
#include "grasp/eye.hpp"
#include "grasp/holding.hpp"
#include "grasp/parallel_grasps.hpp"
#include "grasp/reach.hpp"
#include "grasp/removal.hpp"
#include "grasp/scene_search.hpp"
#include "grasp/score.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>

namespace bin_scenes {

struct Grasper::State {
  std::mutex mutex;
  std::map<std::string, std::shared_ptr<const PartGrasps>> known;

  /// The lock is held throughout: a second thread waits for the first one's result.
  std::shared_ptr<const PartGrasps> grasps_of(const PartModel& part, const Gripper& gripper, double friction) {
    const std::string key = grasp_key(part, gripper, friction);
    const std::lock_guard<std::mutex> lock(mutex);
    auto& slot = known[key];
    if (!slot) slot = std::make_shared<PartGrasps>(part_grasps(part, gripper, friction));
    return slot;
  }
};

Grasper::Grasper() : state_(std::make_unique<State>()) {}
Grasper::~Grasper() = default;

namespace {

double best(const std::vector<double>& shares) {
  return shares.empty() ? 1.0 : *std::max_element(shares.begin(), shares.end());
}

/// Rates the grasps of one part by one gripper, and tests whether they are free.
class PartGrasper {
 public:
  PartGrasper(const LoadedRequest& loaded, const PlacedParts& placed, const PlacedPart& part, PartPick& pick,
              std::size_t gripper)
      : placed_(placed),
        part_(part),
        pick_(pick),
        index_(gripper),
        gripper_(loaded.request.grippers[gripper]),
        model_(*loaded.parts[part.line]),
        friction_(pair_friction(gripper_.friction, loaded.request.parts[part.line].friction)),
        lift_(pick.lift.norm() > 0.0 ? Vec3(pick.lift.normalized()) : placed.up()),
        reach_(placed, part, gripper_, lift_) {
    const double mass = mass_of(loaded.request.parts[part.line], model_);
    const Vec3 inertia = -mass * gripper_.acceleration * lift_;
    burden_ = {pick.pull + inertia.norm(), loaded.request.gravity * mass + inertia, part.pose * model_.mass().center,
               lift_};
  }

  /// Appends the grasps that every scene tries and, if the part can be lifted, those that the search in the scene
  /// finds.
  void add_to(std::vector<SceneGrasp>& all, const PartGrasps& grasps, const std::vector<Eye>& eyes) const {
    for (const PartGrasps::Placed& one : grasps.placed) {
      stop_if_cancelled();
      const Pose pose = part_.pose * one.pose;
      if (tilt_of(pose) > gripper_.tilt) {
        ++pick_.tilted;
        continue;
      }
      all.push_back(tried(grasps.grasps[one.of], pose, eyes));
      all.back().grasp = one.of;
    }
    if (!pick_.lifts() || gripper_.free_wanted == 0) return;
    const bool cup = gripper_.type == Gripper::Type::suction;
    const auto keep = [&](const SearchedPose& searched) {
      SceneGrasp grasp = tried(searched.grasp, searched.pose, eyes);
      if (!grasp.free()) return false;
      if (!cup && goes_through(model_, gripper_, searched.grasp)) return false;
      if (cup) grasp.grasp = searched.of;
      if (!searched.listed) all.push_back(std::move(grasp));
      return true;
    };
    const auto is_reached = [&](const Pose& pose, const Aperture& at) {
      SceneGrasp probe;
      probe.pose = pose;
      probe.width = at.width;
      probe.inner = at.inner;
      return !reach_.meets(probe);
    };
    pick_.searches.push_back(search_scene({placed_, part_, model_, gripper_, grasps, friction_}, is_reached, keep));
    pick_.searches.back().gripper = index_;
  }

 private:
  double tilt_of(const Pose& pose) const {
    return std::acos(std::clamp(-(pose.orientation * Vec3::UnitZ()).dot(placed_.up()), -1.0, 1.0));
  }

  SceneGrasp tried(const Grasp& known, const Pose& pose, const std::vector<Eye>& eyes) const {
    SceneGrasp grasp;
    grasp.part = part_.id;
    grasp.gripper = index_;
    grasp.pose = pose;
    grasp.width = known.width;
    grasp.inner = known.inner;
    grasp.force = gripper_.type == Gripper::Type::parallel ? gripper_.force : vacuum_of(known, gripper_);
    const Hold hold = hold_of(known, pose, gripper_, friction_, burden_);
    grasp.friction = hold.friction;
    grasp.columns = columns_of(known, hold, gripper_, friction_, tilt_of(pose));
    if (!pick_.lifts()) {
      grasp.obstacle = SceneGrasp::Obstacle::blocked;
    } else if (hold.safety < 1.0) {
      grasp.obstacle = SceneGrasp::Obstacle::slips;
    } else if (!reach_.meets(grasp)) {
      grasp.columns.clearance = reach_.room(grasp);
    }
    for (const Eye& eye : eyes) eye.look(known, grasp);
    grasp.columns.seen = best(grasp.visible);
    grasp.columns.measured = best(grasp.measured);
    grasp.score = score_of(grasp.columns, gripper_);
    return grasp;
  }

  const PlacedParts& placed_;
  const PlacedPart& part_;
  PartPick& pick_;
  std::size_t index_;
  const Gripper& gripper_;
  const PartModel& model_;
  double friction_;
  const Vec3 lift_;  ///< unit
  Reach reach_;
  Burden burden_{};
};

}  // namespace

SceneGrasps Grasper::find(const Scene& scene, const LoadedRequest& loaded,
                          const std::vector<RangeImage>& images) const {
  const PlacedParts placed(scene, loaded);
  SceneGrasps result;
  result.parts = picks_of(scene, loaded, placed);
  result.removal_order = order_removal(result.parts, placed, result.held_sets);
  BIN_SCENES_ASSERT(result.removal_order.size() == result.parts.size());
  const std::vector<Gripper>& grippers = loaded.request.grippers;
  std::map<std::pair<std::size_t, std::size_t>, std::shared_ptr<const PartGrasps>> known;
  for (std::size_t line = 0; line < loaded.parts.size(); ++line) {
    if (loaded.request.parts[line].stays()) continue;
    for (std::size_t g = 0; g < grippers.size(); ++g) {
      const double friction = pair_friction(grippers[g].friction, loaded.request.parts[line].friction);
      const auto grasps = state_->grasps_of(*loaded.parts[line], grippers[g], friction);
      known[{line, g}] = grasps;
      result.found.push_back({line, g, grasps->grasps.size(), grasps->placed.size(), grasps->coverage, grasps->counts});
    }
  }
  std::vector<Eye> eyes;
  for (const RangeImage& image : images) eyes.emplace_back(image);
  std::size_t next = 0;
  for (const PlacedPart& part : placed.all()) {
    if (!part.movable) continue;
    PartPick& pick = result.parts[next++];
    for (std::size_t g = 0; g < grippers.size(); ++g) {
      const auto first = static_cast<std::ptrdiff_t>(result.grasps.size());
      PartGrasper(loaded, placed, part, pick, g).add_to(result.grasps, *known.at({part.line, g}), eyes);
      std::stable_sort(result.grasps.begin() + first, result.grasps.end(),
                       [](const SceneGrasp& a, const SceneGrasp& b) { return a.score > b.score; });
    }
  }
  BIN_SCENES_ASSERT(next == result.parts.size());
  return result;
}

const char* name_of(SceneGrasp::Obstacle obstacle) {
  switch (obstacle) {
    case SceneGrasp::Obstacle::none:
      return "";
    case SceneGrasp::Obstacle::blocked:
      return "blocked";
    case SceneGrasp::Obstacle::slips:
      return "slips";
    case SceneGrasp::Obstacle::approach:
      return "approach";
    case SceneGrasp::Obstacle::closing:
      return "closing";
    case SceneGrasp::Obstacle::lift:
      return "lift";
  }
  return "?";
}

std::string reason_of(const SceneGrasp& grasp, const PartPick& part) {
  const auto name = [](int id) { return id < 0 ? std::string("the bin") : "part " + std::to_string(id); };
  switch (grasp.obstacle) {
    case SceneGrasp::Obstacle::none:
      return "";
    case SceneGrasp::Obstacle::blocked: {
      std::string text = "lift blocked by";
      for (const int id : part.blocked_by) text += (id == part.blocked_by.front() ? " " : ", ") + name(id);
      return text;
    }
    case SceneGrasp::Obstacle::slips:
      return "slips: " + std::to_string(part.pull).substr(0, 6) + " N to lift the part out";
    default:
      return "gripper meets " + name(grasp.other) + ": " + name_of(grasp.obstacle);
  }
}

namespace {

/// Whether an upright palm does not fit into the bin at any turn about the vertical, so that fingers do not reach the
/// floor.
bool stays_above(const Gripper& gripper, const Bin& bin) {
  const Vec3& room = bin.inner_size;
  return bin.kind == Bin::Kind::box && gripper.finger_depth < room.z() &&
         std::min(gripper.palm.x(), gripper.palm.y()) > std::min(room.x(), room.y());
}

}  // namespace

std::vector<Flag> flags_of(const SceneGrasps& grasps, const Request& request) {
  std::vector<Flag> flags;
  for (const SceneGrasps::Found& found : grasps.found) {
    if (found.grasps > 0) continue;
    const Gripper& gripper = request.grippers[found.gripper];
    flags.push_back({"no_grasp",
                     "'" + gripper.name + "' has no grasp of '" + request.parts[found.line].model +
                         "': " + text_of(found.counts, gripper.type),
                     "choose a gripper that fits the part"});
  }
  for (const Gripper& gripper : request.grippers)
    if (stays_above(gripper, request.bin))
      flags.push_back({"palm_too_wide",
                       "the palm of '" + gripper.name + "' is wider than the bin: fingers reach no deeper than " +
                           std::to_string(std::lround(1e3 * gripper.finger_depth)) + " mm below the rim",
                       "lengthen finger_depth or narrow palm, in m"});
  return flags;
}

}  // namespace bin_scenes
