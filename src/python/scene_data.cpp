#include "scene_data.hpp"

#include "bin_scenes/core/error.hpp"
#include "bin_scenes/output/scene_writer.hpp"
#include "bin_scenes/sensor/gray_image.hpp"
#include "bin_scenes/sensor/sensor_model.hpp"

#include <utility>

namespace bin_scenes::python {

std::vector<std::array<float, 3>>& ImageData::points() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (points_.empty()) points_ = points_of(image);
  return points_;
}

std::vector<std::array<float, 3>>& ImageData::normals() {
  std::vector<std::array<float, 3>>& measured = points();
  const std::lock_guard<std::mutex> lock(mutex_);
  if (normals_.empty()) normals_ = normals_of(image, measured);
  return normals_;
}

std::vector<std::uint8_t>& ImageData::picture_bytes() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (picture_bytes_.empty()) picture_bytes_.assign(image.picture.counts.begin(), image.picture.counts.end());
  return picture_bytes_;
}

bool ImageData::has_gray() const {
  return !image.gray.empty() || !sensor_model(image.sensor.model).gray;
}

std::vector<std::uint8_t>& ImageData::gray() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (gray_.empty()) gray_ = gray_of(image);
  return gray_;
}

Generator::Options options_of(const Wanted& wanted, const Request& request, const std::string& caller) {
  if (wanted.grasps && request.grippers.empty()) {
    throw input_error("grasps are requested, but the request has no grippers", caller,
                      "add for instance grippers=[\"robotiq_2f_85\"]");
  }
  Generator::Options options;
  options.render = wanted.images;
  options.gray = wanted.gray;
  options.grasps = wanted.grasps;
  return options;
}

SceneData::SceneData(Generator::Result&& result, std::shared_ptr<const LoadedRequest> request)
    : scene(std::move(result.scene)), grasps(std::move(result.grasps)), loaded(std::move(request)) {
  for (RangeImage& image : result.images) images.push_back(std::make_shared<ImageData>(std::move(image)));
  for (const ScenePart& part : scene.parts) {
    const Vec3 &at = part.pose.position, &v = part.velocity.linear, &w = part.velocity.angular;
    const Quat& q = part.pose.orientation;
    poses.push_back({at.x(), at.y(), at.z(), q.x(), q.y(), q.z(), q.w()});
    velocities.push_back({v.x(), v.y(), v.z(), w.x(), w.y(), w.z()});
    ids.push_back(part.id);
    lines.push_back(static_cast<std::int32_t>(part.line));
  }
}

std::string SceneData::json() const {
  std::vector<RangeImage> seen;  // of each, what the text describes: depth and cloud are not copied
  for (const auto& data : images) {
    const RangeImage& image = data->image;
    RangeImage& copy = seen.emplace_back();
    copy.sensor = image.sensor;
    copy.device = image.device;
    copy.width = image.width;
    copy.height = image.height;
    copy.label = image.label;
    copy.truth_label = image.truth_label;
    copy.visible = image.visible;
    copy.total = image.total;
    copy.silhouettes = image.silhouettes;
  }
  return scene_json(scene, *loaded, seen);
}

std::string SceneData::grasps_json() const {
  return bin_scenes::grasps_json(*grasps, scene, loaded->request);
}

}  // namespace bin_scenes::python
