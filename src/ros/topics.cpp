#include "topics.hpp"

#include "bin_scenes/scene/sensor_name.hpp"

namespace bin_scenes {

std::string topic::of_sensor(const char* name, const std::string& sensor, std::size_t sensors) {
  const std::string space = graph_name(sensor);
  return sensors == 1 || space == "camera" ? name : space + "/" + name;
}

void set_stamp(SceneMessages& messages, const ros::Time& stamp) {
  messages.scene.header.stamp = messages.done.stamp = stamp;
  for (auto& marker : messages.markers.markers) marker.header.stamp = stamp;
  for (auto& transform : messages.parts.transforms) transform.header.stamp = stamp;
  for (auto& transform : messages.statics.transforms) transform.header.stamp = stamp;
}

SceneMessages scene_messages(const Scene& scene, const LoadedRequest& loaded, const Frames& frames,
                             const ros::Time& stamp) {
  SceneMessages messages = {scene_message(scene, loaded.request, frames, stamp),
                            scene_markers(scene, loaded, frames, stamp),
                            part_transforms(scene, frames, stamp),
                            static_transforms(scene, frames, stamp),
                            {}};
  messages.done = messages.scene.header;
  return messages;
}

}  // namespace bin_scenes
