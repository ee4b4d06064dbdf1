#include "bag_writer.hpp"

#include "scene_bag.hpp"

namespace bin_scenes {

ros::Time bag_stamp(std::size_t index) {
  constexpr std::uint32_t year_2025 = 1735689600;  // s since the epoch, to its begin
  return ros::Time(year_2025 + static_cast<std::uint32_t>(index), 0);
}

void write_bag(const std::string& path, const Scene& scene, const LoadedRequest& loaded,
               const std::vector<RangeImage>& images, const ros::Time& stamp, const Frames& frames,
               const std::string& name_space) {
  const SceneMessages messages = scene_messages(scene, loaded, frames, stamp);
  SceneBag::unharmed(path, [&] {
    SceneBag bag(path, name_space);
    const auto write = [&](const std::string& topic, const auto& message, Latch latch) {
      bag.write(topic, stamp, message, latch);
    };
    write(topic::tf_static, messages.statics, Latch::yes);  // first, so that a player knows the frames at once
    write(topic::tf, messages.parts, Latch::yes);
    write(topic::scene, messages.scene, Latch::yes);
    write(topic::markers, messages.markers, Latch::yes);
    for (std::size_t i = 0; i < images.size(); ++i) {
      const ImageMessages image = image_messages(images[i], stamp, frames.prefix);
      const auto name = [&](const char* relative) {
        return topic::of_sensor(relative, images[i].sensor.name, images.size());
      };
      write(name(topic::points), image.points, Latch::yes);
      write(name(topic::depth), image.depth, Latch::yes);
      if (image.camera_info) write(name(topic::camera_info), *image.camera_info, Latch::yes);
      write(name(topic::labels), image.labels, Latch::yes);
      write(name(topic::validity), image.validity, Latch::yes);
      if (!image.picture) continue;
      write(name(topic::picture), *image.picture, Latch::yes);
      if (image.camera_info) write(name(topic::picture_info), *image.camera_info, Latch::yes);
    }
    write(topic::acquisition_done, messages.done, Latch::no);
    bag.close();
  });
}

}  // namespace bin_scenes
