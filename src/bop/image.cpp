/// A scene's images as BOP has them: poses in the camera, masks, visibility, grey and depth. Nothing is written here
/// (writer.cpp).
#include "bop/image.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/sensor/gray_image.hpp"
#include "bin_scenes/sensor/resolve.hpp"
#include "bin_scenes/sensor/sensor_model.hpp"
#include "bop/visibility.hpp"
#include "core/in_parallel.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace bin_scenes {

namespace {

using Json = nlohmann::ordered_json;

Json row_major(const Mat3& m) {
  return {m(0, 0), m(0, 1), m(0, 2), m(1, 0), m(1, 1), m(1, 2), m(2, 0), m(2, 1), m(2, 2)};
}

/// Parts that have a pose and are no distractors, each at the place of its id as far as ids go without a gap; the last
/// ones fill the gaps.
std::vector<const ScenePart*> in_places(const Scene& scene) {
  std::vector<const ScenePart*> there;
  for (const ScenePart& part : scene.parts) {
    if (is_there(part.state) && part.pose.finite() && !part.distractor) there.push_back(&part);
  }
  std::vector<const ScenePart*> places(there.size(), nullptr), late;
  for (const ScenePart* part : there) {
    const auto id = static_cast<std::size_t>(part->id);
    if (id < places.size()) {
      places[id] = part;
    } else {
      late.push_back(part);
    }
  }
  auto next = late.begin();
  for (const ScenePart*& place : places) {
    if (!place) place = *next++;
  }
  return places;
}

}  // namespace

nlohmann::ordered_json in_mm(const Vec3& v) {
  return {millimetres * v.x(), millimetres * v.y(), millimetres * v.z()};
}

std::vector<int> bop_object_ids(const std::vector<PartModelPtr>& parts) {
  std::vector<int> ids;
  std::vector<PartModelPtr> distinct;
  for (const PartModelPtr& part : parts) {
    auto known = std::find(distinct.begin(), distinct.end(), part);
    if (known == distinct.end()) known = distinct.insert(distinct.end(), part);
    ids.push_back(static_cast<int>(known - distinct.begin()) + 1);
  }
  return ids;
}

namespace {

/// The depth image as its readers will see it, as distance from the camera.
std::vector<float> stored_distances(const RangeImage& image, const std::vector<std::uint16_t>& counts) {
  std::vector<float> depth(counts.size());
  std::transform(counts.begin(), counts.end(), depth.begin(),
                 [&](std::uint16_t count) { return static_cast<float>(count * image.sensor.depth_scale); });
  return distances(depth, lens_of(image.sensor));
}

BopImage bop_image(const std::vector<const ScenePart*>& places, const std::vector<PartModelPtr>& parts,
                   const RangeImage& image, const BopOptions& options) {
  BopImage bop;
  const Pose bin_in_camera = image.sensor.pose.value_or(Pose()).inverse();
  const Pose bin_in_device = image.true_sensor().pose.value_or(Pose()).inverse();  // where masks are drawn
  const std::vector<int> object_ids = options.object_ids.empty() ? bop_object_ids(parts) : options.object_ids;
  const std::vector<std::uint16_t> counts = counted_depth(image.depth, image.sensor.depth_scale);
  bop.camera = {{"cam_K", image.sensor.k},
                {"depth_scale", millimetres * image.sensor.depth_scale},
                {"cam_R_w2c", row_major(bin_in_camera.orientation.toRotationMatrix())},
                {"cam_t_w2c", in_mm(bin_in_camera.position)}};
  bop.width = image.width, bop.height = image.height;
  bop.counts = counts;
  bop.gray = gray_of(image);
  bop.seen = &image;
  const std::vector<PixelBox> boxes = visible_boxes(image, image.visible.size());
  const std::vector<float> distance = options.tolerance > 0.0 ? stored_distances(image, counts) : std::vector<float>();
  std::vector<BopVisibility> seen(places.size());
  in_parallel(places.size(), [&](std::size_t i) {
    const ScenePart& part = *places[i];
    const Mesh& mesh = parts.at(part.line)->mesh();
    std::optional<BopVisibility> measured;
    if (!distance.empty())
      measured = bop_visibility(mesh, bin_in_camera * part.pose, lens_of(image.sensor), distance, options.tolerance);
    seen[i] = measured ? std::move(*measured)
                       : true_visibility(image, counts, part.id, boxes[static_cast<std::size_t>(part.id)], mesh,
                                         bin_in_device * part.pose);
  });
  bop.truth = Json::array();
  bop.info = Json::array();
  for (std::size_t i = 0; i < places.size(); ++i) {
    const ScenePart& part = *places[i];
    const Pose pose = bin_in_camera * part.pose;
    BopVisibility& v = seen[i];
    bop.truth.push_back({{"cam_R_m2c", row_major(pose.orientation.toRotationMatrix())},
                         {"cam_t_m2c", in_mm(pose.position)},
                         {"obj_id", object_ids.at(part.line)},
                         {"id", part.id}});
    bop.info.push_back({{"bbox_obj", v.box},
                        {"bbox_visib", v.visible_box},
                        {"px_count_all", v.all},
                        {"px_count_valid", v.valid},
                        {"px_count_visib", v.visible},
                        {"visib_fract", v.all ? static_cast<double>(v.visible) / static_cast<double>(v.all) : 0.0}});
    bop.ids.push_back(part.id);
    bop.visible.push_back(std::move(v.visible_mask));
    if (!image.silhouettes.empty() || !distance.empty()) bop.whole.push_back(std::move(v.whole_mask));
  }
  return bop;
}

}  // namespace

std::vector<BopImage> bop_images(const Scene& scene, const std::vector<PartModelPtr>& parts,
                                 const std::vector<RangeImage>& images, const BopOptions& options) {
  const std::vector<const ScenePart*> places = in_places(scene);
  for (const RangeImage& image : images) {
    const std::string why = bop_misfit(image.sensor);
    if (!why.empty()) throw input_error(why, "sensors: " + image.sensor.name, bop_misfit_remedy);
  }
  std::vector<BopImage> all;
  for (const RangeImage& image : images) all.push_back(bop_image(places, parts, image, options));
  return all;
}

}  // namespace bin_scenes
