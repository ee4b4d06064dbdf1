/// scene.json from scene, request and images; its text is made by the tables of its keys (config/scene_file.hpp).
#include "bin_scenes/output/scene_writer.hpp"
#include "output/boxes.hpp"

#include <algorithm>

namespace bin_scenes {

namespace {

std::vector<PartTruth> truth_of(const Scene& scene, const RangeImage& image, const std::vector<PartModelPtr>& models) {
  const std::vector<PixelBox> boxes = visible_boxes(image, image.visible.size());
  const Pose bin_in_camera = image.sensor.pose.value_or(Pose()).inverse();
  const Sensor& device = image.true_sensor();
  const Pose bin_in_device = device.pose.value_or(Pose()).inverse();
  std::vector<std::size_t> measured(image.visible.size(), 0);
  if (image.label.size() == image.seen_label().size())  // else profiles of a laser, which are no view
    for (std::size_t i = 0; i < image.label.size(); ++i)
      if (image.label[i] != 0 && image.label[i] == image.seen_label()[i]) ++measured.at(image.label[i] - 1u);
  std::vector<PartTruth> truth;
  for (const ScenePart& part : scene.parts) {
    if (!is_there(part.state) || !part.pose.finite() || part.distractor) continue;
    const auto id = static_cast<std::size_t>(part.id);
    const PixelBox whole = projected_box(models.at(part.line)->mesh(), bin_in_device * part.pose, device);
    const double all = static_cast<double>(image.total.at(id));
    PartTruth& seen = truth.emplace_back();
    seen.id = part.id;
    seen.pose_in_camera = bin_in_camera * part.pose;
    seen.visible_fraction = all > 0.0 ? static_cast<double>(image.visible.at(id)) / all : 0.0;
    seen.visible_box = boxes.at(id).xywh();
    seen.whole_box = whole.xywh();
    seen.visible_pixels = image.visible.at(id);
    seen.measured_pixels = measured.at(id);
    seen.all_pixels = image.total.at(id);
  }
  return truth;
}

SceneModel model_of(const PartLine& line, const std::string& sha256) {
  SceneModel model;
  model.model = line.model;
  model.sha256 = sha256;
  model.unit = line.unit;
  model.scale = line.scale;
  model.thickness = line.thickness;
  model.solid = line.solid;
  model.tessellation = line.tessellation;
  return model;
}

}  // namespace

SceneFile scene_file(const Scene& scene, const LoadedRequest& loaded, const std::vector<RangeImage>& images) {
  const Request& request = loaded.request;
  SceneFile file;
  file.seed = scene.seed;
  file.index = scene.index;
  file.bin = request.bin;
  file.table = request.table;
  file.gravity = request.gravity;
  file.request_sha256 = request.text_sha256;
  for (std::size_t i = 0; i < scene.sensors.size(); ++i) {
    file.sensors.push_back(SceneSensor{scene.sensors[i], std::nullopt});
    if (i < images.size()) file.sensors.back().truth = truth_of(scene, images[i], loaded.parts);
  }
  for (std::size_t line = 0; line < std::min(scene.model_sha256.size(), request.parts.size()); ++line)
    file.models.push_back(model_of(request.parts[line], scene.model_sha256[line]));
  file.parts = scene.parts;
  file.report = scene.report;
  return file;
}

std::string scene_json(const Scene& scene, const LoadedRequest& loaded, const std::vector<RangeImage>& images) {
  return scene_text(scene_file(scene, loaded, images));
}

}  // namespace bin_scenes
