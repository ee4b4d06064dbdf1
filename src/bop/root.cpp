/// Writes camera.json, targets and description from the files of the scenes themselves, so that shares that were merged
/// give the same bytes. Also prints the lines that bop_toolkit needs to know the set.
#include "bop/root.hpp"

#include "bin_scenes/config/plan.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/output/scene_writer.hpp"
#include "bop/json_file.hpp"

#include <algorithm>
#include <optional>
#include <vector>

namespace bin_scenes {

extern const char* const toolkit_classic_py;
extern const char* const toolkit_industrial_py;

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Split on which estimators are evaluated.
std::string evaluated_split(const BopFolder& folder) {
  for (const char* wanted : {"test", "val"})
    for (const std::string& name : folder.splits)
      if (name == wanted) return name;
  return folder.splits.front();
}

struct SensorInfo {
  std::string name;
  int width = 0, height = 0;
  std::size_t views = 0;
  std::vector<std::string> modalities;
  Json camera;  ///< entry of scene_camera.json of its first image
};

std::vector<SensorInfo> sensors_of(const BopFolder& folder) {
  std::vector<SensorInfo> all;
  if (folder.sensors.empty()) return all;
  const std::vector<BopPlace> places = bop_places(folder.layout, folder.sensors, folder.first_split);
  const fs::path scene = folder.scene(folder.first_split, folder.scenes(folder.first_split).front());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto known =
        std::find_if(all.begin(), all.end(), [&](const SensorInfo& one) { return one.name == places[i].sensor; });
    if (known != all.end()) {
      ++known->views;
      continue;
    }
    SensorInfo info{places[i].sensor, folder.sensors[i].width, folder.sensors[i].height, 1, {}, {}};
    for (const BopPlace::File& file : places[i].files) info.modalities.push_back(file.modality);
    if (const auto cameras = json_map_in<Json>(BopFiles{scene, places[i].suffix}.camera()))
      info.camera = cameras->value(std::to_string(places[i].image), Json());
    all.push_back(std::move(info));
  }
  return all;
}

Json camera_json(const SensorInfo& sensor) {
  const Json k = sensor.camera.value("cam_K", Json::array({0, 0, 0, 0, 0, 0, 0, 0, 1}));
  return {{"cx", k.at(2)},        {"cy", k.at(5)}, {"depth_scale", sensor.camera.value("depth_scale", 0.0)},
          {"fx", k.at(0)},        {"fy", k.at(4)}, {"height", sensor.height},
          {"width", sensor.width}};
}

struct Targets {
  Json localization = Json::array();  ///< bop19: by object
  Json detection = Json::array();     ///< bop24: by image
  Json views = Json::array();         ///< multi-view bop25: by scene
};

/// Images that are looked at together: all views of the evaluated sensor, or of every sensor where it has one.
Json views_together(const std::vector<SensorInfo>& sensors, const std::string& evaluated) {
  Json views = Json::array();
  for (const SensorInfo& sensor : sensors)
    if (sensor.name == evaluated && sensor.views > 1)
      for (std::size_t view = 0; view < sensor.views; ++view) views.push_back({sensor.name, view});
  if (!views.empty()) return views;
  for (const SensorInfo& sensor : sensors)
    for (std::size_t view = 0; view < sensor.views; ++view) views.push_back({sensor.name, view});
  return views;
}

std::size_t total(const std::map<int, int>& seen) {
  std::size_t all = 0;
  for (const auto& [object, count] : seen) all += static_cast<std::size_t>(count);
  return all;
}

Targets targets_of(const BopFolder& folder, const std::vector<SensorInfo>& sensors) {
  Targets targets;
  const Json views = views_together(sensors, folder.layout.sensor);
  const std::string split = evaluated_split(folder);
  for (const std::size_t scene : folder.scenes(split)) {
    const BopFiles files{folder.scene(split, scene), bop_suffix(folder.layout)};
    const auto truth = json_map_in<Json>(files.truth()), info = json_map_in<Json>(files.info());
    if (!truth || !info) continue;
    for (const auto& [image, entries] : truth->items()) {
      std::map<int, int> seen;  // by object
      const Json& of_image = info->value(image, Json::array());
      for (std::size_t i = 0; i < std::min(entries.size(), of_image.size()); ++i)
        if (of_image[i].value("visib_fract", 0.0) >= bop_least_visible) ++seen[entries[i].value("obj_id", 0)];
      if (folder.most_targets > 0 && total(seen) > folder.most_targets) continue;
      const std::size_t number = std::stoul(image);
      for (const auto& [object, count] : seen)
        targets.localization.push_back(
            {{"im_id", number}, {"inst_count", count}, {"obj_id", object}, {"scene_id", scene}});
      if (!seen.empty()) targets.detection.push_back({{"im_id", number}, {"scene_id", scene}});
    }
    targets.views.push_back({{"im_id", views}, {"scene_id", scene}});
  }
  return targets;
}

Json description(const BopFolder& folder, const std::vector<SensorInfo>& sensors) {
  const bool industrial = folder.layout.kind == BopLayout::Kind::industrial;
  Json json = {{"made_by", "bin_scenes " + folder.version},
               {"layout", industrial ? "industrial" : "classic"},
               {"visible", folder.tolerance > 0.0 ? "measured" : "truth"},
               {"visible_tolerance_mm", 1e3 * folder.tolerance},
               {"sensors", Json::object()},
               {"splits", Json::object()},
               {"targets", evaluated_split(folder)}};
  for (const SensorInfo& sensor : sensors)
    json["sensors"][sensor.name] = {
        {"modalities", sensor.modalities}, {"width", sensor.width}, {"height", sensor.height}, {"views", sensor.views}};
  for (const std::string& split : folder.splits) json["splits"][split] = folder.scenes(split).size();
  if (industrial) json["evaluate"] = {{"sensor", folder.layout.sensor}, {"modality", folder.layout.modality}};
  return json;
}

}  // namespace

std::vector<std::size_t> BopFolder::scenes(const std::string& split) const {
  std::vector<std::size_t> numbers;
  std::error_code not_there;
  for (const fs::directory_entry& entry : fs::directory_iterator(root / split, not_there)) {
    const std::string name = entry.path().filename().string();
    if (name.find_first_not_of("0123456789") == std::string::npos) numbers.push_back(std::stoul(name));
  }
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

std::map<std::string, std::string> bop_root_files(const BopFolder& folder) {
  const std::vector<SensorInfo> sensors = sensors_of(folder);
  const Targets targets = targets_of(folder, sensors);
  std::map<std::string, std::string> files;
  const auto put = [&](const std::string& name, const Json& json) { files[name] = json.dump(1) + "\n"; };
  const bool industrial = folder.layout.kind == BopLayout::Kind::industrial;
  for (const SensorInfo& sensor : sensors) {
    if (industrial) put("camera_" + sensor.name + ".json", camera_json(sensor));
    if (industrial ? sensor.name == folder.layout.sensor : &sensor == &sensors.front())
      put("camera.json", camera_json(sensor));
  }
  put("dataset_info.json", description(folder, sensors));
  put("test_targets_bop19.json", targets.localization);
  put("test_targets_bop24.json", targets.detection);
  if (industrial) put("test_targets_multiview_bop25.json", targets.views);
  return files;
}

std::string crowded_targets(const BopFolder& folder, const std::string& name) {
  const std::size_t kept = name == "xyzibd" ? 2 * bop_most_estimates : bop_most_estimates;
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> seen;  // parts by scene and image
  for (const auto& target : targets_of(folder, sensors_of(folder)).localization)
    seen[{target.at("scene_id"), target.at("im_id")}] += target.at("inst_count").get<std::size_t>();
  std::size_t crowded = 0, most = 0;
  for (const auto& [image, parts] : seen) {
    crowded += parts > kept;
    most = std::max(most, parts);
  }
  if (crowded == 0) return "";
  return std::to_string(crowded) + " of " + std::to_string(seen.size()) + " target images have more than " +
         std::to_string(kept) + " visible parts, up to " + std::to_string(most) + "; bop_toolkit keeps " +
         std::to_string(kept) +
         " estimates an image, so that even the truth scores below 1. Set bop: {most_targets: " + std::to_string(kept) +
         "} in the plan, or pour fewer parts";
}

void write_bop_root(const BopFolder& folder) {
  make_directory(folder.root);
  for (const auto& [name, text] : bop_root_files(folder)) write_text((folder.root / name).string(), text);
}

namespace {

Json size_of(const SensorInfo& sensor) {
  return {sensor.width, sensor.height};
}

/// What the template of an industrial entry says of the sensors.
Json industrial_values(const BopFolder& folder, const std::vector<SensorInfo>& sensors) {
  Json values = {{"eval_sensor", folder.layout.sensor}, {"eval_modality", folder.layout.modality}};
  for (const SensorInfo& sensor : sensors) {
    values["modalities"][sensor.name] = sensor.modalities;
    for (const std::string& modality : sensor.modalities)
      values["extensions"][sensor.name][modality] = folder.layout.tif ? ".tif" : ".png";
    values["sizes"][sensor.name] = size_of(sensor);
    if (sensor.name == folder.layout.sensor) values["sizes"][""] = size_of(sensor);
  }
  return values;
}

}  // namespace

std::string toolkit_entry(const BopFolder& folder, const std::string& name) {
  const auto models = json_map_in<Json>(bop_models_info(folder.models()));
  const std::vector<SensorInfo> sensors = sensors_of(folder);
  if (!models || sensors.empty())
    throw input_error("has no finished folder of BOP's layout by scenes", folder.root.parent_path().string(),
                      "make it with bop among the plan's outputs");
  const bool industrial = folder.layout.kind == BopLayout::Kind::industrial;
  Json values = industrial ? industrial_values(folder, sensors) : Json{{"size", size_of(sensors.front())}};
  values["name"] = name;
  values["obj_ids"] = values["symmetric"] = Json::array();
  for (const auto& [id, model] : models->items()) {
    values["obj_ids"].push_back(std::stoi(id));
    if (model.contains("symmetries_discrete") || model.contains("symmetries_continuous"))
      values["symmetric"].push_back(std::stoi(id));
  }
  for (const std::string& split : folder.splits) values["scene_ids"][split] = folder.scenes(split);
  // Python spells lists, texts and maps of texts as JSON does.
  std::string text = industrial ? toolkit_industrial_py : toolkit_classic_py;
  for (const auto& [key, value] : values.items()) {
    const std::string mark = "{{" + key + "}}";
    for (std::size_t at = 0; (at = text.find(mark, at)) != std::string::npos;)
      text.replace(at, mark.size(), value.dump());
  }
  return text;
}

}  // namespace bin_scenes
