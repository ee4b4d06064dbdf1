/// Grasps of the parts are taken to where the parts lie and asked, cheapest question first: tilt, what blocks the part,
/// what the grasp holds, and what the gripper meets on its way.
#include "bin_scenes/grasp/scene_grasps.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/core/cancel.hpp"
#include "bin_scenes/core/contact.hpp"
#include "bin_scenes/sensor/resolve.hpp"
#include "grasp/gripper_shape.hpp"
#include "grasp/holding.hpp"
#include "grasp/removal.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <numeric>

namespace bin_scenes {

namespace {

constexpr double farthest_back = 3.0;  ///< m: of an approach from outside the bin
constexpr double upright = 0.02;       ///< rad: an approach that the lift retraces

/// Neighbours of a part by distance: the nearest are met most often.
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

/// Where contact points of grasps are in the images.
class Eye {
 public:
  explicit Eye(const RangeImage& image)
      : image_(image),
        lens_(lens_of(image.true_sensor())),
        into_camera_(image.true_sensor().pose.value_or(Pose()).inverse()),
        measures_(image.depth.size() == image.seen_depth().size() && image.label.size() == image.depth.size()) {}

  void look(const Grasp& grasp, SceneGrasp& placed) const {
    std::size_t seen = 0, measured = 0;
    const auto label = static_cast<std::uint16_t>(placed.part + 1);
    for (const Vec3& contact : grasp.contacts) {
      const Vec3 point = into_camera_ * (placed.pose * contact);
      const auto pixel = point.z() > 0.0 ? lens_.project(point) : std::nullopt;
      if (!pixel || !lens_.inside(*pixel)) continue;
      const auto column = std::clamp(static_cast<int>(std::lround(pixel->x())), 0, lens_.width - 1);
      const auto row = std::clamp(static_cast<int>(std::lround(pixel->y())), 0, lens_.height - 1);
      const auto at =
          static_cast<std::size_t>(row) * static_cast<std::size_t>(lens_.width) + static_cast<std::size_t>(column);
      // A pixel shows its middle; the point may lie elsewhere in it, on a slope.
      const double within = 5e-4 + 3.0 * point.z() / lens_.fx;
      if (image_.seen_label()[at] != label || !(std::abs(image_.seen_depth()[at] - point.z()) < within)) continue;
      ++seen;
      measured += measures_ && image_.label[at] == label && std::isfinite(image_.depth[at]);
    }
    const double count = static_cast<double>(std::max<std::size_t>(1, grasp.contacts.size()));
    placed.visible.push_back(static_cast<double>(seen) / count);
    placed.measured.push_back(static_cast<double>(measured) / count);
  }

 private:
  const RangeImage& image_;
  Lens lens_;
  Pose into_camera_;
  bool measures_;  ///< depth and labels are images of the camera, not profiles
};

/// One part among the others, for all grasps of a gripper.
class Attempt {
 public:
  Attempt(const PlacedParts& placed, const PlacedPart& part, const Gripper& gripper)
      : placed_(placed), part_(part), gripper_(gripper), order_(order_around(placed, part)) {}

  void meet(SceneGrasp& grasp) const {
    const Vec3 along = grasp.pose.orientation * Vec3::UnitZ();
    const double cosine = -along.dot(placed_.up());
    const double above = placed_.top() - grasp.pose.position.dot(placed_.up()) + gripper_.finger_depth;
    const double back = std::clamp(above / std::max(cosine, 0.05), 0.0, farthest_back);
    if (check(approach_sweeps(gripper_, grasp.width, back, gripper_.clearance), SceneGrasp::Obstacle::approach, grasp))
      return;
    if (check(closing_sweeps(gripper_, grasp.width, gripper_.clearance), SceneGrasp::Obstacle::closing, grasp)) return;
    if (cosine > std::cos(upright)) return;
    const Vec3 lift = grasp.pose.orientation.conjugate() * (std::max(0.0, above) * placed_.up());
    std::vector<Sweep> lifted;
    for (const Sweep& body : closed_shape(gripper_, grasp.width, gripper_.clearance))
      lifted.push_back(body.moved(lift));
    check(lifted, SceneGrasp::Obstacle::lift, grasp);
  }

 private:
  bool check(const std::vector<Sweep>& sweeps, SceneGrasp::Obstacle where, SceneGrasp& grasp) const {
    for (const Sweep& sweep : sweeps) {
      const auto other = placed_.met_by(sweep.placed(grasp.pose), order_);
      if (!other) continue;
      grasp.obstacle = where;
      grasp.other = *other;
      return true;
    }
    return false;
  }

  const PlacedParts& placed_;
  const PlacedPart& part_;
  const Gripper& gripper_;
  std::vector<std::size_t> order_;
};

}  // namespace

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

/// Everything that the grasps of a scene are found with.
struct Search {
  const LoadedRequest& loaded;
  const PlacedParts& placed;
  std::vector<Eye> eyes;

  void of_part(const PlacedPart& part, PartPick& pick, std::size_t gripper, const PartGrasps& grasps,
               std::vector<SceneGrasp>& all) const {
    const Gripper& g = loaded.request.grippers[gripper];
    const PartLine& line = loaded.request.parts[part.line];
    const PartModel& model = *loaded.parts[part.line];
    const double friction = pair_friction(g.friction, line.friction);
    const Burden burden{pick.pull, loaded.request.gravity * mass_of(line, model), part.pose * model.mass().center,
                        placed.up()};
    const Attempt attempt(placed, part, g);
    BIN_SCENES_ASSERT(
        each_is(grasps.placed, [&](const PartGrasps::Placed& one) { return one.of < grasps.grasps.size(); }));
    for (const PartGrasps::Placed& one : grasps.placed) {
      stop_if_cancelled();
      SceneGrasp grasp;
      grasp.pose = part.pose * one.pose;
      const double tilt = std::acos(std::clamp(-(grasp.pose.orientation * Vec3::UnitZ()).dot(placed.up()), -1.0, 1.0));
      if (tilt > g.tilt) {
        ++pick.tilted;
        continue;
      }
      const Grasp& known = grasps.grasps[one.of];
      grasp.part = part.id;
      grasp.gripper = gripper;
      grasp.grasp = one.of;
      grasp.width = known.width;
      grasp.force = g.type == Gripper::Type::parallel ? g.force : g.force - g.stiffness * known.gap;
      const Hold hold = hold_of(known, grasp.pose, g, friction, burden);
      grasp.score = hold.score;
      grasp.friction = hold.friction;
      for (const Eye& eye : eyes) eye.look(known, grasp);
      if (!pick.blocked_by.empty()) {
        grasp.obstacle = SceneGrasp::Obstacle::blocked;
      } else if (!(hold.score > 0.0)) {
        grasp.obstacle = SceneGrasp::Obstacle::slips;
      } else {
        attempt.meet(grasp);
      }
      all.push_back(std::move(grasp));
    }
  }
};

}  // namespace

SceneGrasps Grasper::find(const Scene& scene, const LoadedRequest& loaded,
                          const std::vector<RangeImage>& images) const {
  const PlacedParts placed(scene, loaded);
  SceneGrasps result;
  result.parts = picks_of(scene, loaded, placed);
  result.removal_order = order_removal(result.parts, placed);
  BIN_SCENES_ASSERT(result.removal_order.size() <= result.parts.size());
  const std::vector<Gripper>& grippers = loaded.request.grippers;
  std::map<std::pair<std::size_t, std::size_t>, std::shared_ptr<const PartGrasps>> known;
  for (std::size_t line = 0; line < loaded.parts.size(); ++line) {
    if (loaded.request.parts[line].fixed) continue;
    for (std::size_t g = 0; g < grippers.size(); ++g) {
      const double friction = pair_friction(grippers[g].friction, loaded.request.parts[line].friction);
      const auto grasps = state_->grasps_of(*loaded.parts[line], grippers[g], friction);
      known[{line, g}] = grasps;
      result.found.push_back({line, g, grasps->grasps.size(), grasps->placed.size(), grasps->coverage, grasps->counts});
    }
  }
  Search search{loaded, placed, {}};
  for (const RangeImage& image : images) search.eyes.emplace_back(image);
  std::size_t next = 0;
  for (const PlacedPart& part : placed.all()) {
    if (!part.movable) continue;
    PartPick& pick = result.parts[next++];
    for (std::size_t g = 0; g < grippers.size(); ++g)
      search.of_part(part, pick, g, *known.at({part.line, g}), result.grasps);
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

/// Whether an upright palm does not go into the bin, however it is turned, and fingers do not reach the floor.
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
