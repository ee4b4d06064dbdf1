/// Converts grasps to ROS messages. It serves the services get_grasps and pick_part, and makes the markers of grasps.
#pragma once

#include "bin_scenes/grasp/scene_grasps.hpp"
#include "frames.hpp"
#include "messages.hpp"

#include <visualization_msgs/MarkerArray.h>

#include <vector>

namespace bin_scenes {

/// Returns the requested grasps, the best first. Throws an input Error for an id that does not exist.
std::vector<SceneGrasp> chosen_grasps(const SceneGrasps& all, const bin_scenes_msgs::GetGrasps::Request& asked);

void fill(bin_scenes_msgs::GetGrasps::Response& response, const std::vector<SceneGrasp>& chosen, const SceneGrasps& all,
          const Request& request, const Frames& frames, const ros::Time& stamp);

/// Fills in which share of the contacts each sensor sees, for grasps that were found with images.
void fill_shares(bin_scenes_msgs::GetGrasps::Response& response, const std::vector<SceneGrasp>& chosen,
                 const std::vector<Sensor>& sensors);

/// Returns the part that a call picks by its grasp. Throws an input Error if the grasp is of another part, or not free.
PartPick picked_by(const SceneGrasps& all, const Request& request, const bin_scenes_msgs::PickPart::Request& asked);

/// Returns markers of fingers, cups and palms, from green (best score) to red (score 0), and deletes earlier markers.
visualization_msgs::MarkerArray grasp_markers(const std::vector<SceneGrasp>& grasps, const Request& request,
                                              const Frames& frames, const ros::Time& stamp);

}  // namespace bin_scenes
