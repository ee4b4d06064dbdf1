#include "bin_scenes/core/error.hpp"
#include "bin_scenes/output/scene_writer.hpp"
#include "output/boxes.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <set>

namespace bin_scenes {

namespace fs = std::filesystem;

namespace {

using Json = nlohmann::ordered_json;

constexpr double millimetres = 1e3;

std::string six_digits(std::size_t number) {
  char text[24];
  std::snprintf(text, sizeof(text), "%06zu", number);
  return text;
}

Json row_major(const Mat3& m) {
  return {m(0, 0), m(0, 1), m(0, 2), m(1, 0), m(1, 1), m(1, 2), m(2, 0), m(2, 1), m(2, 2)};
}
Json in_mm(const Vec3& v) {
  return {millimetres * v.x(), millimetres * v.y(), millimetres * v.z()};
}

/// Parts that have a pose, each at the place of its id as far as ids go without a gap; the last ones fill the gaps.
std::vector<const ScenePart*> in_places(const Scene& scene) {
  std::vector<const ScenePart*> there;
  for (const ScenePart& part : scene.parts) {
    if (is_there(part.state) && part.pose.finite()) there.push_back(&part);
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

void write_gray(const std::string& path, const RangeImage& image) {
  std::vector<std::uint8_t> gray;
  gray.reserve(image.intensity.size());
  for (const float value : image.intensity) {
    gray.push_back(std::isfinite(value) ? static_cast<std::uint8_t>(255.0f * std::clamp(value, 0.0f, 1.0f) + 0.5f) : 0);
  }
  write_bytes(path, png8(image.width, image.height, 1, gray));
}

void make_directory(const fs::path& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error) throw environment_error("cannot be made: " + error.message(), path.string(), "check permissions");
}

}  // namespace

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

void write_bop(const std::string& directory, const Scene& scene, const std::vector<PartModelPtr>& parts,
               const std::vector<RangeImage>& images) {
  const fs::path root(directory);
  for (const char* folder : {"depth", "gray", "mask_visib"}) make_directory(root / folder);
  if (!images.empty() && !images[0].silhouettes.empty()) make_directory(root / "mask");
  const std::vector<int> object_ids = bop_object_ids(parts);
  const std::vector<const ScenePart*> places = in_places(scene);
  Json camera = Json::object(), truth = Json::object(), info = Json::object();
  for (std::size_t n = 0; n < images.size(); ++n) {
    const RangeImage& image = images[n];
    const std::string key = std::to_string(n), file = six_digits(n);
    const Pose bin_in_camera = image.sensor.pose.value_or(Pose()).inverse();
    camera[key] = {{"cam_K", image.sensor.k},
                   {"depth_scale", millimetres * image.sensor.depth_scale},
                   {"cam_R_w2c", row_major(bin_in_camera.orientation.toRotationMatrix())},
                   {"cam_t_w2c", in_mm(bin_in_camera.position)}};
    write_bytes((root / "depth" / (file + ".png")).string(),
                png16(image.width, image.height, counted_depth(image.depth, image.sensor.depth_scale)));
    write_gray((root / "gray" / (file + ".png")).string(), image);
    const std::vector<PixelBox> boxes = visible_boxes(image, image.visible.size());
    std::vector<std::size_t> valid(image.visible.size());
    for (const std::uint16_t label : image.label) {
      if (label) ++valid[label - 1u];
    }
    truth[key] = Json::array();
    info[key] = Json::array();
    for (const ScenePart* placed : places) {
      const ScenePart& part = *placed;
      const Pose pose = bin_in_camera * part.pose;
      const std::size_t visible = image.visible.at(part.id), total = image.total.at(part.id);
      const int width = image.sensor.width, height = image.sensor.height;
      const Bytes seen = mask_png(width, height, visible_mask(image, part.id, boxes[part.id]));
      const Bytes whole =
          image.silhouettes.empty() ? Bytes() : mask_png(width, height, whole_mask(image.silhouettes.at(part.id)));
      for (const std::size_t number : std::set<std::size_t>{truth[key].size(), static_cast<std::size_t>(part.id)}) {
        const std::string name = file + "_" + six_digits(number) + ".png";
        write_bytes((root / "mask_visib" / name).string(), seen);
        if (!whole.empty()) write_bytes((root / "mask" / name).string(), whole);
      }
      truth[key].push_back({{"cam_R_m2c", row_major(pose.orientation.toRotationMatrix())},
                            {"cam_t_m2c", in_mm(pose.position)},
                            {"obj_id", object_ids.at(part.line)},
                            {"id", part.id}});
      info[key].push_back({{"bbox_obj", projected_box(parts.at(part.line)->mesh(), pose, image.sensor).xywh()},
                           {"bbox_visib", boxes[part.id].xywh()},
                           {"px_count_all", total},
                           {"px_count_valid", valid.at(part.id)},
                           {"px_count_visib", visible},
                           {"visib_fract", total ? static_cast<double>(visible) / static_cast<double>(total) : 0.0}});
    }
  }
  write_text((root / "scene_camera.json").string(), camera.dump(1) + "\n");
  write_text((root / "scene_gt.json").string(), truth.dump(1) + "\n");
  write_text((root / "scene_gt_info.json").string(), info.dump(1) + "\n");
}

void write_bop_models(const std::string& directory, const std::vector<PartModelPtr>& parts) {
  const fs::path models(directory);
  make_directory(models);
  const std::vector<int> ids = bop_object_ids(parts);
  Json info = Json::object();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::string id = std::to_string(ids[i]);
    if (info.contains(id)) continue;
    const Mesh& mesh = parts[i]->mesh();
    const Aabb box = mesh.bounds();
    const Vec3 lower = millimetres * box.lower, size = millimetres * box.size();
    write_ply((models / ("obj_" + six_digits(ids[i]) + ".ply")).string(), mesh, millimetres);
    // BOP's diameter is the largest distance of two vertices; the box's diagonal bounds it at no cost.
    info[id] = {{"diameter", size.norm()}, {"min_x", lower.x()}, {"min_y", lower.y()}, {"min_z", lower.z()},
                {"size_x", size.x()},      {"size_y", size.y()}, {"size_z", size.z()}};
  }
  write_text((models / "models_info.json").string(), info.dump(1) + "\n");
}

}  // namespace bin_scenes
