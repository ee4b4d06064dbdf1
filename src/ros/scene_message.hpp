/// Converts a scene, its report, its sensors and its bin to messages (msg/). The functions are free of side effects and
/// are tested by reading every field of the message.
#pragma once

#include "bin_scenes/scene/scene.hpp"
#include "frames.hpp"
#include "messages.hpp"

namespace bin_scenes {

/// `request` is what the scene was made from: its bin and its hash go along.
bin_scenes_msgs::Scene scene_message(const Scene& scene, const Request& request, const Frames& frames,
                                     const ros::Time& stamp);

/// Filled from the table of the report's keys. Throws if the message has no field for a key.
bin_scenes_msgs::SceneReport report_message(Report report);

bin_scenes_msgs::Sensor sensor_message(const Sensor& sensor);
bin_scenes_msgs::Bin bin_message(const Bin& bin);
/// "box", "mesh", "floor", "none": the value of `bin.kind` in messages.
const char* name_of(Bin::Kind kind);

}  // namespace bin_scenes
