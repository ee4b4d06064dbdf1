/// scene.json to and from the struct of its tables.
#include "bin_scenes/config/scene_file.hpp"

#include "bin_scenes/core/error.hpp"
#include "config/json_fields.hpp"
#include "config/scene_file_keys.hpp"

#include <fstream>

namespace bin_scenes {

namespace {

using config::Json;

/// Files of other programs may lack `line`: then a line is a model, in order of first appearance.
void number_lines(const Json& parts, std::vector<ScenePart>& read) {
  std::vector<std::string> models;
  for (std::size_t i = 0; i < read.size(); ++i) {
    if (parts[i].contains("line")) continue;
    const auto known = std::find(models.begin(), models.end(), read[i].model);
    read[i].line = static_cast<std::size_t>(known - models.begin());
    if (known == models.end()) models.push_back(read[i].model);
  }
}

void check_intrinsics(const std::vector<SceneSensor>& sensors) {
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const std::size_t size = sensors[i].k.size();
    if (size != 0 && size != 9)
      throw config::JsonFault{"sensors[" + std::to_string(i) + "].K",
                              "contains " + std::to_string(size) + " numbers instead of 9"};
  }
}

SceneFile read_scene(const Json& json, Strictness strictness) {
  config::expect_map(json, "");
  if (json.value("format", Json()) != scene_format)
    throw config::JsonFault{"format", "is not " + std::string(scene_format)};
  SceneFile scene;
  config::JsonReader reader(json, "", strictness == Strictness::strict);
  visit(reader, scene);
  number_lines(json.at("parts"), scene.parts);
  check_intrinsics(scene.sensors);
  return scene;
}

}  // namespace

std::string scene_text(SceneFile scene) {
  return config::JsonWriter::object(scene).dump(1) + "\n";
}

std::string report_text(Report report) {
  return config::JsonWriter::object(report).dump();
}

SceneFile read_scene_file(const std::string& path, Strictness strictness) {
  std::ifstream file(path);
  if (!file) throw input_error("cannot be read", path, "name a scene.json that exists");
  const std::string remedy = "give a scene.json of format " + std::string(scene_format);
  try {
    return read_scene(Json::parse(file), strictness);
  } catch (const Json::parse_error& error) {
    throw input_error("is not valid JSON, or is incomplete: the error is at byte " + std::to_string(error.byte), path,
                      remedy);
  } catch (const Json::exception& error) {  // numbers beyond all types
    const std::string what = error.what();
    const std::size_t end = what.find("] ");
    throw input_error(end == std::string::npos ? what : what.substr(end + 2), path, remedy);
  } catch (const config::JsonFault& fault) {
    throw input_error((fault.path.empty() ? "" : "'" + fault.path + "': ") + fault.problem, path, remedy);
  }
}

Scene read_scene_json(const std::string& path) {
  SceneFile file = read_scene_file(path);
  Scene scene;
  scene.seed = file.seed;
  scene.index = file.index;
  for (const SceneModel& model : file.models) scene.model_sha256.push_back(model.sha256);
  scene.sensors.assign(file.sensors.begin(), file.sensors.end());
  scene.parts = std::move(file.parts);
  scene.report = std::move(file.report);
  return scene;
}

}  // namespace bin_scenes
