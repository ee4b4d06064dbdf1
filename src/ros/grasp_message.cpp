/// Grasps as messages and markers, and the grasp of a pose that a client sends back.
#include "grasp_message.hpp"

#include "bin_scenes/core/error.hpp"
#include "grasp/gripper_shape.hpp"

#include <algorithm>

namespace bin_scenes {

namespace {

using GraspMarker = visualization_msgs::Marker;

const PartPick* pick_of(const SceneGrasps& all, int id) {
  const auto found = std::find_if(all.parts.begin(), all.parts.end(), [&](const PartPick& p) { return p.id == id; });
  return found == all.parts.end() ? nullptr : &*found;
}

/// Far below the distances at which grasps are thinned, far above what changes of frames round away.
constexpr double same_place = 1e-4;  ///< m
constexpr double same_angle = 1e-3;  ///< rad

/// The grasp of any part nearest to the one that is asked for. Throws an input Error if there is none at that place.
const SceneGrasp& grasp_at(const SceneGrasps& all, const Request& request,
                           const bin_scenes_msgs::PickPart::Request& asked) {
  const auto& grippers = request.grippers;
  const auto gripper =
      std::find_if(grippers.begin(), grippers.end(), [&](const Gripper& one) { return one.name == asked.gripper; });
  if (gripper == grippers.end())
    throw input_error("the request of the scene has no gripper '" + asked.gripper + "'", "pick_part",
                      "name one of its grippers as get_grasps does");
  const auto index = static_cast<std::size_t>(gripper - grippers.begin());
  const Pose pose = pose_from(asked.grasp);
  const SceneGrasp* nearest = nullptr;
  double distance = same_place;
  for (const SceneGrasp& grasp : all.grasps) {
    const double apart = (grasp.pose.position - pose.position).norm();
    if (grasp.gripper != index || !(apart < distance)) continue;
    if (!(grasp.pose.orientation.angularDistance(pose.orientation) < same_angle)) continue;
    distance = apart;
    nearest = &grasp;
  }
  if (!nearest)
    throw input_error("'" + asked.gripper + "' has no grasp at that pose", "pick_part",
                      "ask get_grasps again: its answer holds until the heap changes");
  return *nearest;
}

/// Bodies of a gripper as markers in the bin frame.
class GripperMarkers {
 public:
  GripperMarkers(visualization_msgs::MarkerArray& all, const Frames& frames, const ros::Time& stamp) : all_(all) {
    next_.header.frame_id = frames.bin;
    next_.header.stamp = stamp;
    next_.action = GraspMarker::ADD;
  }

  void add(const SceneGrasp& grasp, const Gripper& g) {
    next_.ns = g.name;
    next_.color.r = static_cast<float>(1.0 - grasp.score);
    next_.color.g = static_cast<float>(grasp.score);
    next_.color.a = 1.0f;
    if (g.type == Gripper::Type::parallel) {
      const double inner_face = 0.5 * g.between_fingers(grasp.aperture());
      for (const Aabb& box : finger_of(g))
        for (const double side : {-1.0, 1.0}) {
          const Vec3 center = box.center() + Vec3(inner_face, 0.0, 0.0);
          body(GraspMarker::CUBE, grasp.pose, Vec3(side * center.x(), side * center.y(), center.z()), box.size());
        }
    } else {
      body(GraspMarker::CYLINDER, grasp.pose, Vec3(0.0, 0.0, -0.5 * g.radius),
           Vec3(2.0 * g.radius, 2.0 * g.radius, g.radius));
      body(GraspMarker::CYLINDER, grasp.pose, Vec3(0.0, 0.0, -0.5 * g.finger_depth),
           Vec3(g.radius, g.radius, g.finger_depth));
    }
    next_.color.a = 0.3f;
    body(GraspMarker::CUBE, grasp.pose * g.flange(), Vec3(0.0, 0.0, 0.5 * g.palm.z()), g.palm);
  }

 private:
  void body(int type, const Pose& gripper, const Vec3& center, const Vec3& size) {
    next_.id = static_cast<int>(all_.markers.size());
    next_.type = type;
    next_.pose = pose_message(gripper * Pose{center, Quat::Identity()});
    next_.scale.x = size.x(), next_.scale.y = size.y(), next_.scale.z = size.z();
    all_.markers.push_back(next_);
  }

  visualization_msgs::MarkerArray& all_;
  GraspMarker next_;
};

}  // namespace

namespace {

void add_part(bin_scenes_msgs::GetGrasps::Response& response, const PartPick& pick) {
  response.part_ids.push_back(pick.id);
  response.loads.push_back(pick.load);
  response.pulls.push_back(pick.pull);
  response.depths.push_back(pick.depth);
  response.lifts.push_back(vector_message(pick.lift));
  response.tilted.push_back(static_cast<int>(pick.tilted));
  response.slight.push_back(pick.slight);
  response.overlap_areas.push_back(pick.overlap.area);
  response.overlap_shares.push_back(pick.overlap.share);
  response.overlap_moves.push_back(vector_message(pick.overlap.move));
  response.overlap_passes.push_back(pick.overlap.passes);
  for (std::size_t i = 0; i < pick.blocked_by.size(); ++i) {
    response.blocked_ids.push_back(pick.id);
    response.blocked_by.push_back(pick.blocked_by[i]);
    response.blocked_areas.push_back(pick.blocked_areas.at(i));
  }
}

/// @param place  of the grasp in the answer
void add_proof(bin_scenes_msgs::GetGrasps::Response& response, int place, const LiftProof& proof) {
  const auto add = [&](const std::vector<int>& ids, bool dragged) {
    for (const int id : ids) {
      if (!dragged && std::find(proof.dragged.begin(), proof.dragged.end(), id) != proof.dragged.end()) continue;
      response.disturbed_by.push_back(static_cast<int>(response.proved.size()));
      response.disturbed_ids.push_back(id);
      response.disturbed_dragged.push_back(dragged);
    }
  };
  add(proof.dragged, true);
  add(proof.moved, false);
  response.proved.push_back(place);
  response.proof_outcomes.emplace_back(name_of(proof.outcome));
  response.proof_slips.push_back(proof.slip);
  response.proof_turns.push_back(proof.turn);
}

void add_search(bin_scenes_msgs::GetGrasps::Response& response, int part, const PartSearch& search,
                const Request& request) {
  response.searched_ids.push_back(part);
  response.searched_grippers.push_back(request.grippers[search.gripper].name);
  response.searched_tried.push_back(static_cast<int>(search.tried));
  response.searched_free.push_back(static_cast<int>(search.free));
  response.searched_least_tilts.push_back(search.least_tilt);
}

/// All that does not belong to single grasps.
void add_scene(bin_scenes_msgs::GetGrasps::Response& response, const SceneGrasps& all, const Request& request) {
  response.removal_order.assign(all.removal_order.begin(), all.removal_order.end());
  for (const PartPick& pick : all.parts) {
    add_part(response, pick);
    for (const PartSearch& search : pick.searches) add_search(response, pick.id, search, request);
  }
  for (std::size_t set = 0; set < all.held_sets.size(); ++set) {
    for (const int id : all.held_sets[set].ids) {
      response.held_ids.push_back(id);
      response.held_sets.push_back(static_cast<int>(set));
    }
    for (const SceneGrasps::Forced& lift : all.held_sets[set].forced) {
      response.forced_ids.push_back(lift.part);
      response.forced_areas.push_back(lift.overlap);
    }
  }
  for (const SceneGrasps::Found& found : all.found) {
    response.model_lines.push_back(static_cast<int>(found.line));
    response.model_grippers.push_back(request.grippers[found.gripper].name);
    response.coverages.push_back(found.coverage);
  }
}

}  // namespace

std::vector<SceneGrasp> chosen_grasps(const SceneGrasps& all, const bin_scenes_msgs::GetGrasps::Request& asked) {
  for (const int id : asked.ids)
    if (!pick_of(all, id))
      throw input_error("there is no part " + std::to_string(id) + " that could be picked", "get_grasps",
                        "leave ids empty for all parts");
  std::vector<SceneGrasp> chosen;
  for (const SceneGrasp& grasp : all.grasps) {
    const bool named = std::find(asked.ids.begin(), asked.ids.end(), grasp.part) != asked.ids.end();
    if ((asked.ids.empty() || named) && (asked.all || grasp.free())) chosen.push_back(grasp);
  }
  std::stable_sort(chosen.begin(), chosen.end(), [](const SceneGrasp& a, const SceneGrasp& b) {
    return a.free() != b.free() ? a.free() : a.score > b.score;
  });
  if (asked.best > 0 && chosen.size() > static_cast<std::size_t>(asked.best))
    chosen.resize(static_cast<std::size_t>(asked.best));
  return chosen;
}

void fill(bin_scenes_msgs::GetGrasps::Response& response, const std::vector<SceneGrasp>& chosen, const SceneGrasps& all,
          const Request& request, const Frames& frames, const ros::Time& stamp) {
  response.poses.header.frame_id = frames.bin;
  response.poses.header.stamp = stamp;
  for (const SceneGrasp& grasp : chosen) {
    response.poses.poses.push_back(pose_message(grasp.pose));
    response.parts.push_back(grasp.part);
    response.grippers.push_back(request.grippers[grasp.gripper].name);
    response.flanges.poses.push_back(pose_message(grasp.pose * request.grippers[grasp.gripper].flange()));
    response.grasps.push_back(grasp.grasp ? static_cast<int>(*grasp.grasp) : -1);
    response.widths.push_back(grasp.width);
    response.inner.push_back(grasp.inner);
    response.scores.push_back(grasp.score);
    for_each_column(grasp.columns, [&](const char*, double value) { response.column_values.push_back(value); });
    response.frictions.push_back(grasp.friction);
    response.free.push_back(grasp.free());
    response.reasons.push_back(reason_of(grasp, *pick_of(all, grasp.part)));
    if (grasp.proof) add_proof(response, static_cast<int>(response.parts.size()) - 1, *grasp.proof);
  }
  for_each_column(GraspColumns(), [&](const char* name, double) { response.columns.emplace_back(name); });
  response.flanges.header = response.poses.header;
  add_scene(response, all, request);
}

void fill_shares(bin_scenes_msgs::GetGrasps::Response& response, const std::vector<SceneGrasp>& chosen,
                 const std::vector<Sensor>& sensors) {
  for (const Sensor& sensor : sensors) response.sensors.push_back(sensor.name);
  for (const SceneGrasp& grasp : chosen) {
    response.visible.insert(response.visible.end(), grasp.visible.begin(), grasp.visible.end());
    response.measured.insert(response.measured.end(), grasp.measured.begin(), grasp.measured.end());
  }
}

PartPick picked_by(const SceneGrasps& all, const Request& request, const bin_scenes_msgs::PickPart::Request& asked) {
  const auto& direction = asked.lift_direction;
  if (asked.ids.size() != 1 || direction.x != 0.0 || direction.y != 0.0 || direction.z != 0.0)
    throw input_error("a grasp takes one part along the lift that get_grasps states", "pick_part",
                      "name one part in ids, and leave lift_direction 0 0 0");
  const PartPick* pick = pick_of(all, asked.ids[0]);
  if (!pick)
    throw input_error("there is no part " + std::to_string(asked.ids[0]) + " that could be picked", "pick_part",
                      "take one that get_grasps returns");
  const SceneGrasp& grasp = grasp_at(all, request, asked);
  if (grasp.part != pick->id)
    throw input_error(
        "the grasp is one of part " + std::to_string(grasp.part) + ", not of part " + std::to_string(pick->id),
        "pick_part", "take part, gripper and pose from the same place of get_grasps' answer");
  if (!grasp.free())
    throw input_error("the grasp is not free: " + reason_of(grasp, *pick), "pick_part",
                      "take one that get_grasps returns as free, or leave gripper empty");
  return *pick;
}

visualization_msgs::MarkerArray grasp_markers(const std::vector<SceneGrasp>& grasps, const Request& request,
                                              const Frames& frames, const ros::Time& stamp) {
  visualization_msgs::MarkerArray all;
  all.markers.emplace_back();
  all.markers[0].action = GraspMarker::DELETEALL;
  all.markers[0].header.frame_id = frames.bin;
  all.markers[0].header.stamp = stamp;
  GripperMarkers markers(all, frames, stamp);
  for (const SceneGrasp& grasp : grasps) markers.add(grasp, request.grippers[grasp.gripper]);
  return all;
}

}  // namespace bin_scenes
