/// The messages that a recording of the live node contains for one scene. Bags and MCAP files share them.
#pragma once

#include "topics.hpp"

#include <string>
#include <vector>

namespace bin_scenes {

enum class Latch { no, yes };

/// Returns the name of a topic of a node in a namespace ("cell", "/cell/"); names that begin with "/" do not change.
std::string recorded_name(const std::string& topic, const std::string& name_space);

/// Calls write(topic, message, latch) for each message of a scene. `images`: empty, or one image for each sensor.
template <class Write>
void for_each_message(const Scene& scene, const LoadedRequest& loaded, const std::vector<RangeImage>& images,
                      const ros::Time& stamp, const Frames& frames, const Write& write) {
  const SceneMessages messages = scene_messages(scene, loaded, frames, stamp);
  write(topic::tf_static, messages.statics, Latch::yes);  // first, so that a player knows the frames at once
  write(topic::tf, messages.parts, Latch::yes);
  write(topic::scene, messages.scene, Latch::yes);
  write(topic::markers, messages.markers, Latch::yes);
  for (const RangeImage& taken : images) {
    const ImageMessages image = image_messages(taken, stamp, frames.prefix);
    const auto name = [&](const char* relative) {
      return topic::of_sensor(relative, taken.sensor.name, images.size());
    };
    write(name(topic::points), image.points, Latch::yes);
    write(name(topic::depth), image.depth, Latch::yes);
    if (image.camera_info) write(name(topic::camera_info), *image.camera_info, Latch::yes);
    write(name(topic::labels), image.labels, Latch::yes);
    write(name(topic::validity), image.validity, Latch::yes);
    if (!taken.gray.empty()) write(name(topic::gray), gray_message(taken, image.points.header), Latch::yes);
    for (const ImageChannel& channel : image_channels())
      if (!channel.topic.empty())
        if (const auto message = channel_message(channel, taken, image.points.header))
          write(name(channel.topic.c_str()), *message, Latch::yes);
    if (!image.picture) continue;
    write(name(topic::picture), *image.picture, Latch::yes);
    if (image.camera_info) write(name(topic::picture_info), *image.camera_info, Latch::yes);
  }
  write(topic::acquisition_done, messages.done, Latch::no);
}

}  // namespace bin_scenes
