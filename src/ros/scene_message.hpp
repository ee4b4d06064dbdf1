/// Converts a scene, its report, its sensors and its bin to messages (msg/). The functions are free of side effects and
/// are tested by reading every field of the message.
#pragma once

#include "bin_scenes/scene/scene.hpp"
#include "frames.hpp"
#include "messages.hpp"

namespace bin_scenes {

/// Converts a scene. `request` is the request from which it was made; the message also contains its bin and its hash.
bin_scenes_msgs::Scene scene_message(const Scene& scene, const Request& request, const Frames& frames,
                                     const ros::Time& stamp);

/// Converts a report by the table of its keys. Throws if the message has no field for a key.
bin_scenes_msgs::SceneReport report_message(Report report);

bin_scenes_msgs::Sensor sensor_message(const Sensor& sensor);
bin_scenes_msgs::Bin bin_message(const Bin& bin);
/// Returns the value of `bin.kind` in messages: "box", "mesh", "floor" or "none".
const char* name_of(Bin::Kind kind);

}  // namespace bin_scenes
