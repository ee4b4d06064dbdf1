/// Scene <-> message, in both directions without loss.
#pragma once

#include "bin_scenes/scene/scene.hpp"
#include "frames.hpp"
#include "messages.hpp"

namespace bin_scenes {

/// `request` is what the scene was made from: its bin and its hash go along.
bin_scenes_msgs::Scene scene_message(const Scene& scene, const Request& request, const Frames& frames,
                                     const ros::Time& stamp);
Scene scene_from(const bin_scenes_msgs::Scene& message);

bin_scenes_msgs::SceneReport report_message(const Report& report);
Report report_from(const bin_scenes_msgs::SceneReport& message);

bin_scenes_msgs::Sensor sensor_message(const Sensor& sensor);
/// Of a finished scene's sensor, whose pose is known.
Sensor sensor_from(const bin_scenes_msgs::Sensor& message);

bin_scenes_msgs::Bin bin_message(const Bin& bin);
/// "box", "mesh", "floor", "none": the value of `bin.kind` in messages.
const char* name_of(Bin::Kind kind);

}  // namespace bin_scenes
