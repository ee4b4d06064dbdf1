#include "recording.hpp"

#include "bin_scenes/scene/sensor_name.hpp"

namespace bin_scenes {

std::string topic::of_sensor(const char* name, const std::string& sensor, std::size_t sensors) {
  const std::string space = graph_name(sensor);
  return sensors == 1 || space == "camera" ? name : space + "/" + name;
}

std::string recorded_name(const std::string& topic, const std::string& name_space) {
  if (topic.front() == '/') return topic;
  std::string space = name_space.empty() || name_space.front() == '/' ? name_space : "/" + name_space;
  while (!space.empty() && space.back() == '/') space.pop_back();
  return space + "/" + topic;
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
