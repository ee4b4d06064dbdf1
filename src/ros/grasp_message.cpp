#include "grasp_message.hpp"

#include "bin_scenes/core/error.hpp"

#include <algorithm>

namespace bin_scenes {

namespace {

using GraspMarker = visualization_msgs::Marker;

const PartPick* pick_of(const SceneGrasps& all, int id) {
  const auto found = std::find_if(all.parts.begin(), all.parts.end(), [&](const PartPick& p) { return p.id == id; });
  return found == all.parts.end() ? nullptr : &*found;
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
    const double tip = g.type == Gripper::Type::parallel ? 0.5 * g.pad_length : 0.0;
    if (g.type == Gripper::Type::parallel) {
      for (const double side : {-0.5, 0.5})
        body(GraspMarker::CUBE, grasp.pose,
             Vec3(side * (grasp.width + g.finger_thickness), 0.0, tip - 0.5 * g.finger_depth),
             Vec3(g.finger_thickness, g.finger_width, g.finger_depth));
    } else {
      body(GraspMarker::CYLINDER, grasp.pose, Vec3(0.0, 0.0, -0.5 * g.radius),
           Vec3(2.0 * g.radius, 2.0 * g.radius, g.radius));
      body(GraspMarker::CYLINDER, grasp.pose, Vec3(0.0, 0.0, -0.5 * g.finger_depth),
           Vec3(g.radius, g.radius, g.finger_depth));
    }
    next_.color.a = 0.3f;
    body(GraspMarker::CUBE, grasp.pose, Vec3(0.0, 0.0, tip - g.finger_depth - 0.5 * g.palm.z()), g.palm);
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
    response.widths.push_back(grasp.width);
    response.scores.push_back(grasp.score);
    response.free.push_back(grasp.free());
    response.reasons.push_back(reason_of(grasp, *pick_of(all, grasp.part)));
  }
  response.removal_order.assign(all.removal_order.begin(), all.removal_order.end());
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
