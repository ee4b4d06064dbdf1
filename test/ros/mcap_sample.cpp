/// Writes one scene, every field of which has a value of its own, as FOLDER/scene.bag, FOLDER/ros1.mcap and
/// FOLDER/ros2.mcap, for test/readers/mcap_test.js.
#include "bag_writer.hpp"
#include "box_mesh.hpp"
#include "mcap_writer.hpp"
#include "scenes.hpp"

namespace {

using namespace bin_scenes;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/// 5 x 3 pixels: odd sizes, so that what follows them has to be padded.
RangeImage image_of(const Sensor& sensor) {
  RangeImage image;
  image.sensor = sensor;
  image.width = image.sensor.width = 5;
  image.height = image.sensor.height = 3;
  for (int i = 0; i < 15; ++i) {
    const auto value = static_cast<float>(i);
    image.depth.push_back(i == 6 ? nan : 0.5f + 0.01f * value);
    image.label.push_back(static_cast<std::uint16_t>(i % 5));  // bin and four parts
    image.normal.push_back({0.01f * value, 0.02f * value, -1.0f});
    image.intensity.push_back(0.05f * value);
    image.snr.push_back(3.0f * value);
    image.validity.push_back(static_cast<std::uint8_t>(i % 9));
  }
  image.visible = {3, 3, 3, 2};
  image.total = {4, 4, 4, 4};
  return image;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) return 2;
  const std::string folder = arguments[1];
  Scene scene = bin_scenes::testing::full_scene();
  scene.sensors[0].distortion = {0.1, -0.2, 0.001, 0.002, 0.3};
  scene.report.reasons.push_back("ümlaut, an empty text follows");
  scene.report.reasons.push_back("");
  LoadedRequest loaded;
  loaded.request = bin_scenes::testing::request_of(scene);
  loaded.request.sensors = scene.sensors;
  loaded.parts = {PartModel::from_mesh(box_mesh(0.02), "bolt.stl"), PartModel::from_mesh(box_mesh(0.03), "nut.stl")};
  std::vector<RangeImage> images;
  for (const Sensor& sensor : scene.sensors) images.push_back(image_of(sensor));
  const ros::Time stamp(1735689642, 987654321);
  write_bag(folder + "/scene.bag", scene, loaded, images, stamp, {}, "cell");
  write_mcap(folder + "/ros1.mcap", McapProfile::ros1, scene, loaded, images, stamp, "cell");
  write_mcap(folder + "/ros2.mcap", McapProfile::ros2, scene, loaded, images, stamp, "cell");
}
