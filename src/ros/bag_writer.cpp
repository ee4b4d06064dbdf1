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
  SceneBag::unharmed(path, [&] {
    SceneBag bag(path, name_space);
    for_each_message(
        scene, loaded, images, stamp, frames,
        [&](const std::string& topic, const auto& message, Latch latch) { bag.write(topic, stamp, message, latch); });
    bag.close();
  });
}

}  // namespace bin_scenes
