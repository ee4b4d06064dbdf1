/// Parses YAML, applies overrides by path, and fills the request through the visitor of its keys. A scene to go on from
/// replaces start poses.
#include "bin_scenes/config/request_reader.hpp"

#include "bin_scenes/config/scene_file.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/core/sha256.hpp"
#include "bin_scenes/sensor/image_settings.hpp"
#include "config/key_reader.hpp"
#include "config/paths.hpp"
#include "config/read_document.hpp"
#include "config/rigs.hpp"
#include "config/views.hpp"
#include "config/yaml_text.hpp"
#include "core/read_file.hpp"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>

namespace bin_scenes {

namespace config {

namespace {

/// parts[0].count or parts.0.count -> parts, 0, count.
std::vector<std::string> split(const std::string& path) {
  std::vector<std::string> words(1);
  for (const char c : path) {
    if (c == '.' || c == '[') {
      if (!words.back().empty()) words.emplace_back();
    } else if (c != ']') {
      words.back() += c;
    }
  }
  return words;
}

/// parts.0.count -> parts[0].count, as messages spell it.
std::string path_of(const std::vector<std::string>& words) {
  std::string path;
  for (const std::string& word : words) {
    const bool index = !word.empty() && word.find_first_not_of("0123456789") == std::string::npos;
    path += index ? "[" + word + "]" : (path.empty() ? "" : ".") + word;
  }
  return path;
}

/// Puts one "path=value" into the tree, and returns the path with its origin.
std::pair<std::string, std::string> apply_override(YAML::Node root, const Override& override) {
  const std::string& text = override.assignment;
  const std::size_t equals = text.find('=');
  const std::string where = override.origin.empty() ? "--set " + text : override.origin;
  if (equals == 0 || equals == std::string::npos) {
    throw input_error("expected key=value", where, "write, for instance, solver.type=bullet");
  }
  const std::vector<std::string> words = split(text.substr(0, equals));
  YAML::Node value;
  try {
    value = load_yaml(text.substr(equals + 1), where);
  } catch (const Error& error) {
    throw input_error("the value is " + error.problem(), where, "quote it, or correct its brackets");
  }
  YAML::Node node;
  node.reset(root);  // operator= would write into the tree instead of moving along it
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (node.IsSequence()) {
      const bool index = words[i].size() < 9 && words[i].find_first_not_of("0123456789") == std::string::npos;
      if (!index || words[i].empty() || std::stoul(words[i]) >= node.size()) {
        throw input_error("'" + words[i] + "' is not an index of a list with the length " + std::to_string(node.size()),
                          where, "count from 0");
      }
      node.reset(node[std::stoul(words[i])]);
    } else if (node.IsMap() || node.IsNull() || !node.IsDefined()) {
      node.reset(node[words[i]]);
    } else {
      throw input_error("'" + words[i - 1] + "' is a single value and has no key '" + words[i] + "'", where,
                        "see docs/use/request.md");
    }
  }
  node = value;
  const std::string path = path_of(words);
  return {path, override.origin.empty() ? "--set " + path : override.origin};
}

YAML::Node parse(const std::string& text, const std::string& file) {
  const YAML::Node document = load_yaml(text, file);
  if (document.IsNull()) {
    throw input_error("the request is empty", file, "it needs at least `parts`; see docs/use/request.md");
  }
  return document;
}

using Where = std::function<std::string(const std::string& path)>;

/// Whether a line of the request is of the model that the scene's line was made of: the same bytes, wherever they lie.
/// A scene that does not state them has only the name of the file.
bool is_model_of(const PartLine& line, const Scene& scene, std::size_t index) {
  if (index < scene.model_sha256.size() && !scene.model_sha256[index].empty()) {
    return scene.model_sha256[index] == line.sha256;
  }
  const auto name = [](const std::string& path) { return std::filesystem::path(path).filename(); };
  return std::all_of(scene.parts.begin(), scene.parts.end(),
                     [&](const ScenePart& part) { return part.line != index || name(part.model) == name(line.model); });
}

/// Start poses of the part lines from an earlier scene. Its parts know the index of their line.
void go_on_from_scene(Request& request, const Where& where, const std::function<bool(const std::string&)>& given) {
  const Scene scene = read_scene_json(request.pour.scene);
  std::vector<std::vector<Pose>> poses(request.parts.size());
  std::vector<std::vector<Twist>> velocities(request.parts.size());
  std::vector<bool> same;
  for (std::size_t line = 0; line < request.parts.size(); ++line)
    same.push_back(is_model_of(request.parts[line], scene, line));
  for (const ScenePart& part : scene.parts) {
    if (part.line >= request.parts.size() || !same[part.line]) {
      throw input_error("part " + std::to_string(part.id) + " of '" + request.pour.scene + "' is a '" + part.model +
                            "' of part line " + std::to_string(part.line) + ", which the request does not have",
                        where("pour.scene"), "list the same models in the same order as for that scene");
    }
    if (part.state == PartState::escaped || !is_there(part.state)) continue;
    poses[part.line].push_back(part.pose);
    velocities[part.line].push_back(part.velocity);
  }
  for (std::size_t i = 0; i < request.parts.size(); ++i) {
    PartLine& line = request.parts[i];
    const std::string key = "parts[" + std::to_string(i) + "]";
    if (!line.poses.empty()) {
      throw input_error("'" + key + ".poses' and 'pour.scene' both give start poses", where(key + ".poses"),
                        "remove one of them");
    }
    if (given(key + ".count") && line.count != poses[i].size()) {
      throw input_error("'" + key + ".count' is " + std::to_string(line.count) + ", but the scene has " +
                            std::to_string(poses[i].size()) + " of these parts",
                        where(key + ".count"), "remove count to use all of them");
    }
    line.count = poses[i].size();
    line.poses = std::move(poses[i]);
    line.velocities = std::move(velocities[i]);
  }
}

void find_pictures(std::vector<Sensor>& sensors, const std::string& base, const PathRules& rules, const Where& where) {
  std::map<std::string, std::string> digests;
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    std::vector<ImageLamp>& lamps = sensors[i].settings.of<ImageSettings>().lamps;
    for (std::size_t k = 0; k < lamps.size(); ++k) {
      const std::string key = "sensors[" + std::to_string(i) + "].lamps[" + std::to_string(k) + "].picture";
      if (lamps[k].picture.empty()) continue;
      lamps[k].picture = resolve_file(lamps[k].picture, base, rules, where(key));
      std::string& digest = digests[lamps[k].picture];
      if (digest.empty()) digest = sha256_of_file(lamps[k].picture);
      lamps[k].picture_sha256 = digest;
    }
  }
}

void complete(Request& request, const std::string& base, const PathRules& rules, const Where& where,
              const std::function<bool(const std::string&)>& given) {
  const auto judge = [&] {
    try {
      check(request);
      check_sensors(request.sensors);
    } catch (const Error& error) {  // check() knows the key, the source its file and line
      throw input_error("'" + error.where() + "': " + error.problem(), where(error.where()), error.remedy());
    }
  };
  struct Model {
    std::string path, sha256;
  };
  std::map<std::string, Model> models;  // thousands of lines may name one
  for (std::size_t i = 0; i < request.parts.size(); ++i) {
    PartLine& line = request.parts[i];
    const std::string key = "parts[" + std::to_string(i) + "].model";
    if (line.model.empty()) throw input_error("'" + key + "' is missing", where(key), "name a mesh file");
    const auto [model, first] = models.try_emplace(line.model);
    if (first) {
      model->second.path = resolve_file(line.model, base, rules, where(key));
      model->second.sha256 = sha256_of_file(model->second.path);
    }
    line.path = model->second.path;
    line.sha256 = model->second.sha256;
  }
  if (!request.bin.mesh.empty()) {
    request.bin.mesh = resolve_file(request.bin.mesh, base, rules, where("bin.mesh"));
    request.bin.mesh_sha256 = sha256_of_file(request.bin.mesh);
  }
  find_pictures(request.sensors, base, rules, where);
  for (std::size_t i = 0; i < request.grippers.size(); ++i) {
    std::string& mesh = request.grippers[i].finger_mesh;
    if (!mesh.empty()) mesh = resolve_file(mesh, base, rules, where("grippers[" + std::to_string(i) + "].finger_mesh"));
  }
  if (!request.pour.scene.empty()) {
    if (request.pour.pattern != Pour::Pattern::given) {
      throw input_error("'pour.scene' needs the pattern `given`", where("pour.scene"), "set pour.pattern: given");
    }
    request.pour.scene = resolve_file(request.pour.scene, base, rules, where("pour.scene"));
    go_on_from_scene(request, where, given);
  }
  judge();
  request.text_sha256 = request_hash(request);
}

}  // namespace

Request read_document(YAML::Node root, const std::string& file, const std::string& base,
                      const std::vector<Override>& overrides, const PathRules& rules, std::vector<Error>* all) {
  std::map<std::string, std::string> origins;
  if (root.IsMap()) put_rig(root, [&](const std::string&) { return file; });  // overrides may change its sensors
  for (const Override& item : overrides) {
    if (!root.IsMap()) continue;
    const auto [path, origin] = apply_override(root, item);
    origins[path] = origin;
    if (path == "rig") put_rig(root, [&, origin = origin](const std::string&) { return origin; });
  }
  Source source(file, std::move(origins));
  if (!root.IsMap()) throw input_error("the request is not a map of keys", file, "write `key: value` lines");
  if (static_cast<const YAML::Node&>(root)["request"])
    throw input_error("this is a plan of a data set and not a request", file,
                      "pass it to the command bin_scenes dataset");
  source.collect(all);
  const auto read_over = [&](Request request) {
    KeyReader reader(root, "", source);
    visit(reader, request);
    reader.finish();
    return request;
  };
  Request request = read_over(Request());
  if (all && !all->empty()) return request;                      // what follows builds on values that are not there
  if (request.solver.preset == SolverSettings::Preset::quick) {  // what is not given is the preset's
    Request quick;
    apply(SolverSettings::Preset::quick, quick);
    request = read_over(quick);
  }
  const auto where = [&](const std::string& path) { return source.where(path); };
  const auto given = [&](const std::string& path) { return source.knows(path); };
  spell_out_views(request, where, given);
  complete(request, base, rules, where, given);
  return request;
}

Request without_places(Request request) {
  if (!request.bin.mesh.empty()) request.bin.mesh = "mesh";
  for (Sensor& sensor : request.sensors)
    for (ImageLamp& lamp : sensor.settings.of<ImageSettings>().lamps)
      if (!lamp.picture_sha256.empty()) lamp.picture = "picture";
  return request;
}

std::string digests_of_pictures(const Request& request) {
  std::string text;
  for (const Sensor& sensor : request.sensors)
    for (const ImageLamp& lamp : sensor.settings.of<ImageSettings>().lamps)
      if (!lamp.picture.empty()) text += lamp.picture_sha256 + "\n";
  return text;
}

namespace {

Request read(const std::string& text, const std::string& file, const std::string& base,
             const std::vector<Override>& overrides, const PathRules& rules) {
  return read_document(parse(text, file), file, base, overrides, rules);
}

}  // namespace

}  // namespace config

Request read_request(const std::string& path, const std::vector<Override>& overrides, const PathRules& rules) {
  std::error_code error;
  const std::filesystem::path absolute = std::filesystem::absolute(path, error);
  if (!std::filesystem::exists(absolute, error)) {
    throw input_error("there is no such request file", path, "check the path");
  }
  if (!std::filesystem::is_regular_file(absolute, error)) {
    throw input_error("the request is not a file", path, "name a YAML file");
  }
  return config::read(read_file(path, config::longest_text), path, absolute.parent_path().string(), overrides, rules);
}

Request read_request_text(const std::string& yaml, const std::string& base_directory,
                          const std::vector<Override>& overrides, const PathRules& rules) {
  return config::read(yaml, "request", base_directory, overrides, rules);
}

std::string request_hash(const Request& request) {
  Request content = config::without_places(request);
  content.scenes = 1;
  content.first = 0;
  std::string text;
  if (!content.bin.mesh.empty()) text += content.bin.mesh_sha256 + "\n";
  for (const PartLine& line : content.parts) {
    if (!line.path.empty()) text += line.sha256 + "\n";
  }
  return sha256_hex(write_request(content) + text + config::digests_of_pictures(content));
}

}  // namespace bin_scenes
