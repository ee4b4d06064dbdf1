/// The command `view`: a finished scene as one HTML page that needs no network.
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/output/scene_writer.hpp"
#include "core/read_file.hpp"
#include "dataset/grasp_view.hpp"
#include "dataset/page.hpp"
#include "tool/commands.hpp"
#include "tool/progress_bar.hpp"
#include "tool/view_cloud.hpp"
#include "tool/view_models.hpp"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <map>
#include <set>

namespace bin_scenes {

extern const char view_page[];

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t most_points = 400'000;  ///< of all sensors; a point takes 25 bytes of the page

/// Numbers as the page's typed arrays have them: little-endian, base64.
template <class Number>
std::string packed(const std::vector<Number>& numbers) {
  Bytes bytes(numbers.size() * sizeof(Number));
  if (!bytes.empty()) std::memcpy(bytes.data(), numbers.data(), bytes.size());
  return base64(bytes);
}

Json packed(const Mesh& mesh) {
  std::vector<float> vertices;
  std::vector<std::uint32_t> triangles;
  for (const Vec3& v : mesh.vertices)
    for (int i = 0; i < 3; ++i) vertices.push_back(static_cast<float>(v[i]));
  for (const Triangle& t : mesh.triangles) triangles.insert(triangles.end(), t.begin(), t.end());
  return {{"vertices", packed(vertices)}, {"triangles", packed(triangles)}};
}

Pose pose_of(const Json& json) {
  Pose pose;
  for (int i = 0; i < 3; ++i) pose.position[i] = json.at("position").at(i).get<double>();
  for (int i = 0; i < 4; ++i) pose.orientation.coeffs()[i] = json.at("orientation_xyzw").at(i).get<double>();
  return pose;
}

/// What decides where the pixels of a sensor look.
Sensor sensor_of(const Json& json) {
  Sensor sensor;
  sensor.name = json.at("name").get<std::string>();
  sensor.model = json.at("model").get<std::string>();
  sensor.width = json.at("width").get<int>();
  sensor.height = json.at("height").get<int>();
  sensor.k = std::vector<double>(9);
  for (std::size_t i = 0; i < 9; ++i) sensor.k[i] = json.at("K").at(i).get<double>();
  sensor.distortion = json.at("distortion").get<std::array<double, 5>>();
  sensor.depth_scale = json.at("depth_scale").get<double>();
  sensor.pose = pose_of(json.at("pose"));
  return sensor;
}

Json packed(const ViewCloud& cloud, const Sensor& sensor) {
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
void add_parts(Json& data, const Json& scene, const std::string& folder, const std::string& models) {
  std::map<std::size_t, std::size_t> place_of;  // line -> its mesh
  for (const Json& part : scene.at("parts")) {
    const Json& pose = part.at("pose");
    if (!pose.is_object() || !pose_of(pose).finite()) continue;
    const auto line = part.at("line").get<std::size_t>();
    if (!place_of.count(line)) {
      place_of[line] = data["meshes"].size();
      data["meshes"].push_back(packed(find_model(scene.at("models").at(line), scene.at("bin"), folder, models)));
    }
    Json row = part;
    row["mesh"] = place_of[line];
    data["parts"].push_back(row);
  }
}

void add_sensors(Json& data, const Json& scene, const std::string& folder) {
  const Json& sensors = scene.at("sensors");
  const std::size_t most = std::max<std::size_t>(most_points / std::max<std::size_t>(sensors.size(), 1), 1000);
  for (Json json : sensors) {
    const Sensor sensor = sensor_of(json);
    const ViewCloud cloud = read_view_cloud(folder, sensor, most);
    if (!cloud.source.empty()) data["clouds"].push_back(packed(cloud, sensor));
    json.erase("truth");  // large, and not shown
    data["sensors"].push_back(json);
  }
}

Json view_data(const Json& scene, const std::string& folder, const std::string& models) {
  Json data = {{"name", fs::weakly_canonical(folder).filename().string()},
               {"seed", scene.at("seed")},
               {"index", scene.at("index")},
               {"bin", scene.at("bin")},
               {"report", scene.value("report", Json::object())}};
  for (const char* list : {"meshes", "parts", "sensors", "clouds"}) data[list] = Json::array();
  add_parts(data, scene, folder, models);
  add_sensors(data, scene, folder);
  data.update(grasp_view(folder));
  if (scene.at("bin").contains("mesh")) data["bin"]["shape"] = packed(find_bin(scene.at("bin"), folder, models));
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
  read_scene_json(file.string());  // tells what is wrong with it
  const std::string library = three_js();
  if (library.empty())
    throw environment_error("three.js, which draws the page, was not found", "view",
                            "install Debian's package libjs-three");
  ProgressBar bar;
  bar.stage(0.0, 1.0, "reading models and clouds");
  Json data;
  try {
    data = view_data(Json::parse(read_file(file.string())), folder, options.models);
  } catch (const Json::exception& error) {
    throw input_error(std::string("is no scene that bin_scenes wrote: ") + error.what(), file.string(),
                      "make the scene anew: generate --overwrite");
  }
  std::string page = view_page;
  put(page, "/*THREE*/", library);
  put(page, "/*DATA*/null", for_script(data.dump(-1, ' ', false, Json::error_handler_t::replace)));
  write_text(path, page);
  bar.clear();
  std::printf("%s: %zu parts, %zu clouds, %.1f MB\n", path.c_str(), data["parts"].size(), data["clouds"].size(),
              static_cast<double>(page.size()) / 1e6);
  if (data["clouds"].empty())
    std::fprintf(stderr, "bin_scenes: no cloud, since %s\n",
                 data["sensors"].empty() ? "the scene has no sensors"
                                         : "no file of one is there (generate --formats json,png,ply)");
  return exit_done;
}

}  // namespace bin_scenes
