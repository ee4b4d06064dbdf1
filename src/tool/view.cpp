/// The command `view`: a finished scene as one HTML page that needs no network.
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/output/scene_writer.hpp"
#include "config/json_fields.hpp"
#include "config/scene_file_keys.hpp"
#include "dataset/grasp_view.hpp"
#include "dataset/page.hpp"
#include "tool/commands.hpp"
#include "tool/packed.hpp"
#include "tool/progress_bar.hpp"
#include "tool/view_cloud.hpp"
#include "tool/view_models.hpp"
#include "tool/view_trace.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <set>

namespace bin_scenes {

extern const char view_page[];

namespace {

namespace fs = std::filesystem;
using config::Json;

constexpr std::size_t most_points = 400'000;  ///< of all sensors; a point takes 25 bytes of the page

Json packed(const Mesh& mesh) {
  std::vector<float> vertices;
  std::vector<std::uint32_t> triangles;
  for (const Vec3& v : mesh.vertices)
    for (int i = 0; i < 3; ++i) vertices.push_back(static_cast<float>(v[i]));
  for (const Triangle& t : mesh.triangles) triangles.insert(triangles.end(), t.begin(), t.end());
  return {{"vertices", packed_array(vertices)}, {"triangles", packed_array(triangles)}};
}

Json packed(const ViewCloud& cloud, const Sensor& sensor) {
  std::vector<float> points;
  for (const auto& p : cloud.points) {
    const Vec3 in_bin = *sensor.pose * Vec3(p[0], p[1], p[2]);
    for (int i = 0; i < 3; ++i) points.push_back(static_cast<float>(in_bin[i]));
  }
  Json json = {{"sensor", sensor.name},
               {"source", cloud.source},
               {"points", packed_array(points)},
               {"labels", packed_array(cloud.labels)},
               {"validity", packed_array(cloud.validity)}};
  if (cloud.has_errors) json["errors"] = packed_array(cloud.errors);
  return json;
}

/// Parts that lie somewhere, with their models.
void add_parts(Json& data, SceneFile& scene, const std::string& folder, const std::string& models) {
  std::map<std::size_t, std::size_t> place_of;  // line -> its mesh
  for (ScenePart& part : scene.parts) {
    if (!part.pose.finite()) continue;
    if (part.line >= scene.models.size())
      throw input_error("is no scene that bin_scenes wrote: it does not name its models", folder + "/scene.json",
                        "make the scene anew: generate --overwrite");
    if (!place_of.count(part.line)) {
      place_of[part.line] = data["meshes"].size();
      data["meshes"].push_back(packed(find_model(scene.models[part.line], scene.bin, folder, models)));
    }
    Json row = config::JsonWriter::object(part);
    row["mesh"] = place_of[part.line];
    data["parts"].push_back(row);
  }
}

void add_sensors(Json& data, SceneFile& scene, const std::string& folder) {
  const std::size_t most = std::max<std::size_t>(most_points / std::max<std::size_t>(scene.sensors.size(), 1), 1000);
  for (SceneSensor& sensor : scene.sensors) {
    const ViewCloud cloud = read_view_cloud(folder, sensor, most);
    if (!cloud.source.empty()) data["clouds"].push_back(packed(cloud, sensor));
    sensor.truth.reset();  // large, and not shown
    data["sensors"].push_back(config::JsonWriter::object(sensor));
  }
}

Json view_data(SceneFile scene, const std::string& folder, const ViewOptions& options) {
  SceneBin bin{scene.bin};
  Json data = {{"name", fs::weakly_canonical(folder).filename().string()},
               {"seed", scene.seed},
               {"index", scene.index},
               {"bin", config::JsonWriter::object(bin)},
               {"report", config::JsonWriter::object(scene.report)}};
  for (const char* list : {"meshes", "parts", "sensors", "clouds"}) data[list] = Json::array();
  add_parts(data, scene, folder, options.models);
  data["trace"] = options.trace.empty() ? Json() : view_trace(options.trace, scene);
  add_sensors(data, scene, folder);
  data.update(grasp_view(folder));
  if (scene.bin.kind == Bin::Kind::mesh) data["bin"]["shape"] = packed(find_bin(scene.bin, folder, options.models));
  return data;
}

/// scene.json of a scene that was named by its folder or by this file.
fs::path scene_file(const std::string& named) {
  std::error_code missing;
  const fs::path path = fs::is_directory(named, missing) ? fs::path(named) / "scene.json" : fs::path(named);
  if (!fs::is_regular_file(path, missing))
    throw input_error("there is no scene", path.string(),
                      "name a folder that holds a scene.json, as generate makes it");
  return path;
}

}  // namespace

int view(const ViewOptions& options) {
  const fs::path file = scene_file(options.scene);
  const std::string folder = file.has_parent_path() ? file.parent_path().string() : ".";
  const std::string path = options.out.empty() ? (fs::path(folder) / "view.html").string() : options.out;
  const SceneFile scene = read_scene_file(file.string(), Strictness::strict);
  const std::string library = three_js();
  if (library.empty())
    throw environment_error("three.js, which draws the page, was not found", "view",
                            "install Debian's package libjs-three");
  ProgressBar bar;
  bar.stage(0.0, 1.0, "reading models and clouds");
  Json data;
  try {
    data = view_data(scene, folder, options);
  } catch (const Json::exception& error) {
    throw input_error(std::string("is no grasps.json that bin_scenes wrote: ") + error.what(), folder,
                      "make the scene anew: generate --overwrite");
  }
  std::string page = view_page;
  put(page, "/*THREE*/", library);
  put(page, "/*DATA*/null", for_script(data.dump(-1, ' ', false, Json::error_handler_t::replace)));
  write_text(path, page);
  bar.clear();
  const std::string samples =
      options.trace.empty() ? "" : std::to_string(data["trace"]["times"].size()) + " samples of the trace, ";
  std::printf("%s: %zu parts, %zu clouds, %s%.1f MB\n", path.c_str(), data["parts"].size(), data["clouds"].size(),
              samples.c_str(), static_cast<double>(page.size()) / 1e6);
  if (data["clouds"].empty())
    std::fprintf(stderr, "bin_scenes: no cloud, since %s\n",
                 data["sensors"].empty() ? "the scene has no sensors"
                                         : "no file of one is there (generate --formats json,png,ply)");
  return exit_done;
}

}  // namespace bin_scenes
