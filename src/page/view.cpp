#include "page/view.hpp"

#include "bin_scenes/core/error.hpp"
#include "bin_scenes/output/scene_writer.hpp"
#include "config/json_fields.hpp"
#include "config/scene_file_keys.hpp"
#include "page/grasp_view.hpp"
#include "page/html.hpp"
#include "page/view_cloud.hpp"
#include "page/view_models.hpp"
#include "page/view_trace.hpp"
#include "scene/palette.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

namespace bin_scenes {

extern const char* const view_page;

namespace {

namespace fs = std::filesystem;
using config::Json;

constexpr std::size_t most_points = 400'000;  ///< of all sensors; a point takes 25 bytes of the page

Json json_of_mesh(const Mesh& mesh) {
  std::vector<float> vertices;
  std::vector<std::uint32_t> triangles;
  for (const Vec3& v : mesh.vertices)
    for (int i = 0; i < 3; ++i) vertices.push_back(static_cast<float>(v[i]));
  for (const Triangle& t : mesh.triangles) triangles.insert(triangles.end(), t.begin(), t.end());
  return {{"vertices", packed(vertices)}, {"triangles", packed(triangles)}};
}

Json json_of_cloud(const ViewCloud& cloud, const Sensor& sensor) {
  std::vector<float> points;
  for (const auto& p : cloud.points) {
    const Vec3 in_bin = *sensor.pose * Vec3(p[0], p[1], p[2]);
    for (int i = 0; i < 3; ++i) points.push_back(static_cast<float>(in_bin[i]));
  }
  Json json = {{"sensor", sensor.name},
               {"source", cloud.source},
               {"points", packed(points)},
               {"labels", packed(cloud.labels)},
               {"validity", packed(cloud.validity)}};
  if (cloud.has_errors) json["errors"] = packed(cloud.errors);
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
      data["meshes"].push_back(json_of_mesh(find_model(scene.models[part.line], scene.bin, folder, models)));
    }
    Json row = config::JsonWriter::object(part);
    row["mesh"] = place_of[part.line];
    row["colour"] = css_colour(part_colour(part.id));
    data["parts"].push_back(row);
  }
}

void add_sensors(Json& data, SceneFile& scene, const std::string& folder) {
  const std::size_t most = std::max<std::size_t>(most_points / std::max<std::size_t>(scene.sensors.size(), 1), 1000);
  for (SceneSensor& sensor : scene.sensors) {
    const ViewCloud cloud = read_view_cloud(folder, sensor, most);
    if (!cloud.source.empty()) data["clouds"].push_back(json_of_cloud(cloud, sensor));
    sensor.truth.reset();  // large, and not shown
    data["sensors"].push_back(config::JsonWriter::object(sensor));
  }
}

Json view_data(SceneFile scene, const std::string& folder, const ViewSources& sources) {
  SceneBin bin{scene.bin};
  Json data = {{"name", fs::weakly_canonical(folder).filename().string()},
               {"seed", scene.seed},
               {"index", scene.index},
               {"bin", config::JsonWriter::object(bin)},
               {"report", config::JsonWriter::object(scene.report)}};
  if (scene.table.height) data["table"] = {{"height", *scene.table.height}, {"colour", css_colour(table_colour)}};
  for (const char* list : {"meshes", "parts", "sensors", "clouds"}) data[list] = Json::array();
  add_parts(data, scene, folder, sources.models);
  data["trace"] = sources.trace.empty() ? Json() : view_trace(sources.trace, scene);
  add_sensors(data, scene, folder);
  data.update(grasp_view(folder));
  if (scene.bin.kind == Bin::Kind::mesh)
    data["bin"]["shape"] = json_of_mesh(find_bin(scene.bin, folder, sources.models));
  return data;
}

}  // namespace

ViewResult write_view(const SceneFile& scene, const std::string& folder, const ViewSources& sources,
                      const std::string& path) {
  const std::string library = three_js();
  if (library.empty())
    throw environment_error("three.js, which draws the page, was not found", "view",
                            "install Debian's package libjs-three");
  Json data;
  try {
    data = view_data(scene, folder, sources);
  } catch (const Json::exception& error) {
    throw input_error(std::string("is no grasps.json that bin_scenes wrote: ") + error.what(), folder,
                      "make the scene anew: generate --overwrite");
  }
  const std::string page = filled_page(view_page, library, data.dump(-1, ' ', false, Json::error_handler_t::replace));
  write_text(path, page);
  const std::size_t samples = sources.trace.empty() ? 0 : data["trace"]["times"].size();
  return {page.size(), data["parts"].size(), data["clouds"].size(), samples};
}

}  // namespace bin_scenes
