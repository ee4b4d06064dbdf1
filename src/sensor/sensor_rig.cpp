#include "bin_scenes/sensor/sensor_rig.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/sensor/calibration.hpp"
#include "bin_scenes/sensor/resolve.hpp"
#include "bin_scenes/sensor/sensor_model.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace bin_scenes {

namespace {

/// Distractors are background to whoever reads labels.
void remove_distractors(const Scene& scene, RangeImage& image, std::vector<Silhouette>& alone) {
  std::vector<char> removed;  // by label
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    if (!scene.parts[i].distractor) continue;
    const auto label = static_cast<std::size_t>(scene.parts[i].id) + 1;
    if (removed.size() <= label) removed.resize(label + 1, 0);
    removed[label] = 1;
    alone[i] = Silhouette();
  }
  if (removed.empty()) return;
  for (std::vector<std::uint16_t>* labels : {&image.label, &image.truth_label})
    for (std::uint16_t& label : *labels)
      if (label < removed.size() && removed[label]) label = 0;
}

/// How much of each part is seen, and would be if it were alone.
void count_pixels(RangeImage& image, const Scene& scene, std::vector<Silhouette>&& alone) {
  int largest = -1;
  for (const ScenePart& part : scene.parts) largest = std::max(largest, part.id);
  const auto ids = static_cast<std::size_t>(largest + 1);
  image.visible.assign(ids, 0);
  image.total.assign(ids, 0);
  image.silhouettes.resize(ids);
  BIN_SCENES_ASSERT(alone.size() == scene.parts.size());
  BIN_SCENES_ASSERT(each_is(image.seen_label(), [&](std::uint16_t label) { return label <= ids; }));
  for (const std::uint16_t label : image.seen_label()) {
    if (label) ++image.visible[label - 1u];
  }
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    const auto id = static_cast<std::size_t>(scene.parts[i].id);
    image.total[id] = alone[i].count;
    image.silhouettes[id] = std::move(alone[i]);
  }
}

/// A heap may grow around what looks at it: such an image is empty, or of a part's inside.
void flag_what_stands_inside(const Sensor& sensor, Scene& scene, const std::vector<PartModelPtr>& parts) {
  std::vector<std::pair<const char*, Pose>> places = light_of(sensor);
  places.insert(places.begin(), {"camera", *sensor.pose});
  for (const auto& [what, pose] : places) {
    for (const ScenePart& part : scene.parts) {
      if (!is_there(part.state) || !part.pose.finite()) continue;
      const PartModel& model = *parts[part.line];
      const Vec3 here = part.pose.inverse() * pose.position;
      if ((here - model.mass().center).norm() > model.radius() || !model.query().inside(here)) continue;
      scene.report.flags.push_back({"sensor_inside_part",
                                    std::string("the ") + what + " of sensor '" + sensor.name +
                                        "' stands inside part " + std::to_string(part.id),
                                    "move it away from the heap, or pour fewer parts"});
    }
  }
}

}  // namespace

SensorRig::SensorRig() : cache_(std::make_unique<SceneryCache>()) {}
SensorRig::~SensorRig() = default;

std::vector<RangeImage> SensorRig::render(Scene& scene, const LoadedRequest& loaded, bool gray) {
  std::vector<RangeImage> images(scene.sensors.size());
  render(scene, loaded, std::vector<bool>(images.size(), true), images, gray);
  return images;
}

void SensorRig::render(Scene& scene, const LoadedRequest& loaded, const std::vector<bool>& wanted,
                       std::vector<RangeImage>& images, bool gray) {
  std::vector<std::size_t> to_make;
  for (std::size_t s = 0; s < scene.sensors.size(); ++s)
    if (wanted.at(s) && images.at(s).depth.empty()) to_make.push_back(s);
  if (to_make.empty()) return;

  const Scenery scenery(scene, loaded, *cache_);
  const Surfaces surfaces = surfaces_of(scene, loaded);
  for (const std::size_t s : to_make) {
    const Sensor& sensor = scene.sensors[s];
    flag_what_stands_inside(sensor, scene, loaded.parts);
    const Sensor device = true_device(scene.sensors, s, scene.seed);
    SeenWithMasks seen = see(scenery, lens_of(device), *device.pose, sensor.near, sensor.far);
    const Draw draw{scene.seed, scene.index, s, gray};
    RangeImage& image = images[s] = measure(scenery, std::move(seen.view), device, surfaces, draw);
    report_as_believed(image, device, sensor);
    remove_distractors(scene, image, seen.alone);
    count_pixels(image, scene, std::move(seen.alone));
    scene.report.profile.count("views");
    scene.report.profile.count("noisy_images", sensor.noise && !sensor_model(sensor.model).exact);
    std::size_t there = 0;
    for (std::size_t i = 0; i < scenery.part_count(); ++i) there += scenery.part(i).mesh != nullptr;
    scene.report.profile.count("silhouettes", there);
    for (ScenePart& part : scene.parts) {
      if (part.distractor) continue;
      const auto id = static_cast<std::size_t>(part.id);
      const double all = static_cast<double>(image.total[id]);
      part.visible_fraction[sensor.name] = all > 0.0 ? static_cast<double>(image.visible[id]) / all : 0.0;
    }
  }
}

}  // namespace bin_scenes
