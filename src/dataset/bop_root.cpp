/// Writes camera.json, targets and description from the files of the scenes themselves, so that shares that were merged
/// give the same bytes. Also prints the lines that bop_toolkit needs to know the set.
#include "dataset/bop_root.hpp"

#include "bin_scenes/core/error.hpp"
#include "bin_scenes/output/bop_layout.hpp"
#include "bin_scenes/output/scene_writer.hpp"
#include "core/read_file.hpp"
#include "dataset/whole_folders.hpp"

#include <algorithm>
#include <optional>
#include <vector>

namespace bin_scenes {

namespace fs = std::filesystem;
using OrderedJson = nlohmann::ordered_json;

namespace {

constexpr double least_visible = 0.1;  ///< share of an object that an estimator has to find, as bop_toolkit has it

/// Numbers of the scenes of a split, ascending.
std::vector<std::size_t> scenes_of(const DataFolder& folder, const std::string& split) {
  std::vector<std::size_t> scenes;
  std::error_code not_there;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder.root / "bop" / split, not_there)) {
    const std::string name = entry.path().filename().string();
    if (name.find_first_not_of("0123456789") == std::string::npos) scenes.push_back(std::stoul(name));
  }
  std::sort(scenes.begin(), scenes.end());
  return scenes;
}

std::optional<OrderedJson> ordered_json_in(const fs::path& path) {
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) return std::nullopt;
  OrderedJson json = OrderedJson::parse(read_file(path.string()), nullptr, false);
  return json.is_object() ? std::optional<OrderedJson>(std::move(json)) : std::nullopt;
}

/// Split on which estimators are evaluated.
std::string evaluated_split(const DataSetFacts& facts) {
  for (const char* wanted : {"test", "val"})
    for (const auto& [name, share] : facts.split)
      if (name == wanted) return name;
  return facts.split.front().first;
}

struct SensorInfo {
  std::string name;
  int width = 0, height = 0;
  std::size_t views = 0;
  std::vector<std::string> modalities;
  OrderedJson camera;  ///< entry of scene_camera.json of its first image
};

/// Sensors of the first scene; all scenes have the same, but for their poses. None if there is no scene.
std::vector<SensorInfo> sensors_of(const DataFolder& folder, const DataSetFacts& facts) {
  std::vector<SensorInfo> all;
  for (const auto& [split, share] : facts.split) {
    const std::vector<std::size_t> scenes = scenes_of(folder, split);
    if (scenes.empty()) continue;
    const auto scene = scene_in(folder.scene(scenes.front()));
    if (!scene) continue;
    const std::vector<Sensor> sensors(scene->sensors.begin(), scene->sensors.end());
    const std::vector<BopPlace> places = bop_places(facts.bop, sensors, split);
    for (std::size_t i = 0; i < places.size(); ++i) {
      const auto known =
          std::find_if(all.begin(), all.end(), [&](const SensorInfo& one) { return one.name == places[i].sensor; });
      if (known != all.end()) {
        ++known->views;
        continue;
      }
      SensorInfo info{places[i].sensor, sensors[i].width, sensors[i].height, 1, {}, {}};
      for (const BopPlace::File& file : places[i].files) info.modalities.push_back(file.modality);
      const auto cameras =
          ordered_json_in(folder.bop(facts, scenes.front()) / ("scene_camera" + places[i].suffix + ".json"));
      if (cameras) info.camera = cameras->value(std::to_string(places[i].image), OrderedJson());
      all.push_back(std::move(info));
    }
    return all;
  }
  return all;
}

OrderedJson camera_json(const SensorInfo& sensor) {
  const OrderedJson k = sensor.camera.value("cam_K", OrderedJson::array({0, 0, 0, 0, 0, 0, 0, 0, 1}));
  return {{"cx", k.at(2)},        {"cy", k.at(5)}, {"depth_scale", sensor.camera.value("depth_scale", 0.0)},
          {"fx", k.at(0)},        {"fy", k.at(4)}, {"height", sensor.height},
          {"width", sensor.width}};
}

struct Targets {
  OrderedJson localization = OrderedJson::array();  ///< bop19: by object
  OrderedJson detection = OrderedJson::array();     ///< bop24: by image
  OrderedJson views = OrderedJson::array();         ///< multi-view bop25: by scene
};

/// Images that are looked at together: all views of the evaluated sensor, or of every sensor where it has one.
OrderedJson views_together(const std::vector<SensorInfo>& sensors, const std::string& evaluated) {
  OrderedJson views = OrderedJson::array();
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

Targets targets_of(const DataFolder& folder, const DataSetFacts& facts, const std::vector<SensorInfo>& sensors) {
  Targets targets;
  const std::string suffix = facts.bop.kind == BopLayout::Kind::classic ? "" : "_" + facts.bop.sensor;
  const OrderedJson views = views_together(sensors, facts.bop.sensor);
  for (const std::size_t scene : scenes_of(folder, evaluated_split(facts))) {
    const fs::path path = folder.bop(facts, scene);
    const auto truth = ordered_json_in(path / ("scene_gt" + suffix + ".json"));
    const auto info = ordered_json_in(path / ("scene_gt_info" + suffix + ".json"));
    if (!truth || !info) continue;
    for (const auto& [image, entries] : truth->items()) {
      std::map<int, int> seen;  // by object
      const OrderedJson& of_image = info->value(image, OrderedJson::array());
      for (std::size_t i = 0; i < std::min(entries.size(), of_image.size()); ++i)
        if (of_image[i].value("visib_fract", 0.0) >= least_visible) ++seen[entries[i].value("obj_id", 0)];
      if (facts.most_targets > 0 && total(seen) > facts.most_targets) continue;
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

OrderedJson description(const DataFolder& folder, const DataSetFacts& facts, const std::vector<SensorInfo>& sensors) {
  const bool industrial = facts.bop.kind == BopLayout::Kind::industrial;
  OrderedJson json = {{"made_by", "bin_scenes " + facts.version},
                      {"layout", industrial ? "industrial" : "classic"},
                      {"visible", facts.tolerance > 0.0 ? "measured" : "truth"},
                      {"visible_tolerance_mm", 1e3 * facts.tolerance},
                      {"sensors", OrderedJson::object()},
                      {"splits", OrderedJson::object()},
                      {"targets", evaluated_split(facts)}};
  for (const SensorInfo& sensor : sensors)
    json["sensors"][sensor.name] = {
        {"modalities", sensor.modalities}, {"width", sensor.width}, {"height", sensor.height}, {"views", sensor.views}};
  for (const auto& [split, share] : facts.split) json["splits"][split] = scenes_of(folder, split).size();
  if (industrial) json["evaluate"] = {{"sensor", facts.bop.sensor}, {"modality", facts.bop.modality}};
  return json;
}

}  // namespace

std::map<std::string, std::string> bop_root_files(const DataFolder& folder, const DataSetFacts& facts) {
  const std::vector<SensorInfo> sensors = sensors_of(folder, facts);
  const Targets targets = targets_of(folder, facts, sensors);
  std::map<std::string, std::string> files;
  const auto put = [&](const std::string& name, const OrderedJson& json) { files[name] = json.dump(1) + "\n"; };
  const bool industrial = facts.bop.kind == BopLayout::Kind::industrial;
  for (const SensorInfo& sensor : sensors) {
    if (industrial) put("camera_" + sensor.name + ".json", camera_json(sensor));
    if (industrial ? sensor.name == facts.bop.sensor : &sensor == &sensors.front())
      put("camera.json", camera_json(sensor));
  }
  put("dataset_info.json", description(folder, facts, sensors));
  put("test_targets_bop19.json", targets.localization);
  put("test_targets_bop24.json", targets.detection);
  if (industrial) put("test_targets_multiview_bop25.json", targets.views);
  return files;
}

std::string crowded_targets(const DataFolder& folder, const std::string& name) {
  const DataSetFacts facts = read_facts(folder.root);
  const std::size_t kept = name == "xyzibd" ? 2 * bop_most_estimates : bop_most_estimates;
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> seen;  // parts by scene and image
  for (const auto& target : targets_of(folder, facts, sensors_of(folder, facts)).localization)
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

void write_bop_root(const DataFolder& folder, const DataSetFacts& facts) {
  make_directory(folder.root / "bop");
  for (const auto& [name, text] : bop_root_files(folder, facts))
    write_text((folder.root / "bop" / name).string(), text);
}

namespace {

/// Python's own spelling of lists and dictionaries is JSON's, but for numbers as keys and for tuples.
std::string python(const OrderedJson& json) {
  return json.dump();
}

std::string size_of(const SensorInfo& sensor) {
  return "(" + std::to_string(sensor.width) + ", " + std::to_string(sensor.height) + ")";
}

std::string industrial_lines(const DataSetFacts& facts, const std::vector<SensorInfo>& sensors) {
  const std::string extension = facts.bop.tif ? ".tif" : ".png";
  OrderedJson modalities = OrderedJson::object(), extensions = OrderedJson::object();
  std::string sizes;
  for (const SensorInfo& sensor : sensors) {
    modalities[sensor.name] = sensor.modalities;
    for (const std::string& modality : sensor.modalities) extensions[sensor.name][modality] = extension;
    sizes += python(sensor.name) + ": " + size_of(sensor) + ", ";
    if (sensor.name == facts.bop.sensor) sizes += "\"\": " + size_of(sensor) + ", ";
  }
  std::string separately;
  for (const SensorInfo& sensor : sensors) separately += python(sensor.name) + ": False, ";
  return "        sensor_modalities_have_separate_annotations = {" + separately + "}\n" +
         "        p[\"im_modalities\"] = " + python(modalities) + "\n" +      //
         "        p[\"im_size\"] = {" + sizes + "}\n" +                       //
         "        p[\"eval_modality\"] = \"" + facts.bop.modality + "\"\n" +  //
         "        p[\"eval_sensor\"] = \"" + facts.bop.sensor + "\"\n" +      //
         "        exts = " + python(extensions) + "\n" +                      //
         "        supported_error_types = [\"ad\", \"add\", \"adi\", \"mssd\", \"mspd\"]\n";
}

}  // namespace

std::string toolkit_entry(const DataFolder& folder, const std::string& name) {
  const DataSetFacts facts = read_facts(folder.root);
  const auto models = ordered_json_in(folder.root / "bop" / "models" / "models_info.json");
  const std::vector<SensorInfo> sensors = sensors_of(folder, facts);
  if (!facts.wants("bop") || !models || sensors.empty())
    throw input_error("has no finished folder of BOP's layout by scenes", folder.root.string(),
                      "make it with bop among the plan's outputs");
  OrderedJson ids = OrderedJson::array(), symmetric = OrderedJson::array();
  for (const auto& [id, model] : models->items()) {
    ids.push_back(std::stoi(id));
    if (model.contains("symmetries_discrete") || model.contains("symmetries_continuous"))
      symmetric.push_back(std::stoi(id));
  }
  std::string scenes;
  for (const auto& [split, share] : facts.split)
    scenes += python(split) + ": " + python(OrderedJson(scenes_of(folder, split))) + ", ";
  std::string text = "# obj_ids of get_model_params():\n        \"" + name + "\": " + python(ids) + ",\n" +
                     "# symmetric_obj_ids of get_model_params():\n        \"" + name + "\": " + python(symmetric) +
                     ",\n" + "# get_split_params(), before its last else:\n    elif dataset_name == \"" + name +
                     "\":\n        p[\"scene_ids\"] = {" + scenes +
                     "}[split if split_type is None else split + \"_\" + split_type]\n";
  if (facts.bop.kind == BopLayout::Kind::industrial) return text + industrial_lines(facts, sensors);
  return text + "        p[\"im_size\"] = " + size_of(sensors.front()) +
         "\n        p[\"im_modalities\"] = [\"gray\", \"depth\"]\n        gray_ext = \".tiff\"\n";
}

}  // namespace bin_scenes
