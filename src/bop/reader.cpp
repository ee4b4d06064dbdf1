/// Reads scene_gt, scene_camera and scene_gt_info of every scene below a folder. Poses are turned into a world whose z
/// points up, given by the set or by the caller.
#include "bop/reader.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/core/error.hpp"
#include "bop/image.hpp"
#include "bop/json_file.hpp"
#include "bop/layout.hpp"
#include "core/formatted.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <set>

namespace bin_scenes {

namespace fs = std::filesystem;

namespace {

constexpr double metres = 1e-3;  ///< a millimetre

nlohmann::json parsed(const fs::path& path) {
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored))
    throw input_error("is missing", path.string(), "audit needs scene_gt, scene_camera and models of a BOP data set");
  auto json = json_map_in<nlohmann::json>(path);
  if (!json) throw input_error("is no JSON map", path.string(), "repair the file, or leave the scene out");
  return *std::move(json);
}

/// Row-major rotation; small errors of rounding are taken out.
Quat rotation(const nlohmann::json& rows, const std::string& where) {
  const auto v = rows.get<std::array<double, 9>>();
  Mat3 m;
  for (int i = 0; i < 9; ++i) m(i / 3, i % 3) = v[static_cast<std::size_t>(i)];
  if (!((m * m.transpose() - Mat3::Identity()).norm() < 1e-2 && m.determinant() > 0.0))
    throw input_error("the matrix is no rotation", where, "write rows of an orthonormal, right-handed matrix");
  return Quat(m).normalized();
}

Vec3 millimetres_of(const nlohmann::json& json) {
  const auto v = json.get<std::array<double, 3>>();
  return metres * Vec3(v[0], v[1], v[2]);
}

void find_scenes(const fs::path& folder, int levels, std::vector<fs::path>& scenes) {
  if (!bop_suffixes_in(folder).empty()) return scenes.push_back(folder);
  if (levels == 0) return;
  std::vector<fs::path> below;
  std::error_code not_there;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, not_there))
    if (entry.is_directory()) below.push_back(entry.path());
  std::sort(below.begin(), below.end());
  for (const fs::path& path : below) find_scenes(path, levels - 1, scenes);
}

fs::path models_for(const fs::path& root, const std::string& given) {
  if (!given.empty()) return given;
  fs::path place = fs::absolute(root).lexically_normal();
  for (int level = 0; level < 4; ++level, place = place.parent_path())
    if (fs::exists(bop_models_info(place / "models"))) return place / "models";
  throw input_error("there is no folder models with models_info.json beside or above it", root.string(),
                    "name the folder by --models");
}

/// Turns `up` to z.
Quat upright(const Vec3& up) {
  return Quat::FromTwoVectors(up, Vec3::UnitZ()).normalized();
}

std::string suffix_for(const fs::path& scene, const std::string& sensor) {
  const std::vector<std::string> there = bop_suffixes_in(scene);
  if (sensor.empty()) return there.front();
  if (std::find(there.begin(), there.end(), "_" + sensor) != there.end()) return "_" + sensor;
  std::string known;
  for (const std::string& suffix : there) known += " " + (suffix.empty() ? "(none)" : suffix.substr(1));
  throw input_error("has no sensor '" + sensor + "'", scene.string(), "there are:" + known);
}

/// An entry of scene_camera.json: "cam_R_w2c", which XYZ-IBD spells "R_w2c" in places. Null: it is not there.
nlohmann::json of_world(const nlohmann::json& camera, const std::string& key) {
  return camera.value("cam_" + key, camera.value(key, nlohmann::json()));
}

bool states_world(const nlohmann::json& camera) {
  return !of_world(camera, "R_w2c").is_null() && !of_world(camera, "t_w2c").is_null();
}

BopView view_of(const fs::path& scene, const std::string& suffix, const std::string& key, const nlohmann::json& camera,
                const nlohmann::json& truth, const nlohmann::json& info, const BopReadOptions& options) {
  const std::string where = scene.string() + ", image " + key;
  BopView view;
  view.scene = scene;
  view.suffix = suffix;
  view.image = std::stoi(key);
  view.k = camera.at("cam_K").get<std::array<double, 9>>();
  view.depth_scale = metres * camera.value("depth_scale", 1.0);
  Pose camera_in_world;
  if (states_world(camera)) {
    const Pose world_in_camera{millimetres_of(of_world(camera, "t_w2c")),
                               rotation(of_world(camera, "R_w2c"), where + ", cam_R_w2c")};
    camera_in_world = world_in_camera.inverse();
    if (options.up) camera_in_world = Pose{Vec3::Zero(), upright(*options.up)} * camera_in_world;
  } else {
    camera_in_world.orientation = upright(options.up.value_or(-Vec3::UnitZ()));
  }
  view.camera = camera_in_world;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const std::string entry = where + ", entry " + std::to_string(i);
    BopPart part;
    part.object = truth[i].at("obj_id");
    if (truth[i].contains("id")) part.id = truth[i].at("id").get<int>();
    part.in_camera = {millimetres_of(truth[i].at("cam_t_m2c")), rotation(truth[i].at("cam_R_m2c"), entry)};
    part.in_world = camera_in_world * part.in_camera;
    if (!part.in_world.finite()) throw input_error("the pose is not finite", entry, "leave the entry out");
    if (i < info.size()) {
      part.visible = info[i].at("visib_fract");
      part.px_visible = info[i].at("px_count_visib");
    }
    BIN_SCENES_ASSERT(is_rigid(part.in_camera) && is_rigid(part.in_world));
    view.parts.push_back(part);
  }
  return view;
}

/// Parts of centimetres at kilometres, or kilometres across at decimetres: somebody wrote metres.
void check_units(const BopSet& set, const nlohmann::json& info, const fs::path& models) {
  for (const BopView& view : set.views) {
    for (const BopPart& part : view.parts) {
      const double diameter = metres * info.at(std::to_string(part.object)).at("diameter").get<double>();
      const double distance = part.in_camera.position.norm();
      if (distance > 0.02 * diameter && distance < 2000.0 * diameter) continue;
      throw input_error(formatted("object %d, %.3g mm across, is %.3g mm from the camera of image %d: lengths are not "
                                  "all in millimetres",
                                  part.object, diameter / metres, distance / metres, view.image),
                        view.scene.string(), "BOP has millimetres in " + models.string() + " and in scene_gt");
    }
  }
}

}  // namespace

BopSet read_bop_set(const std::string& root, const BopReadOptions& options) {
  BopSet set;
  std::vector<fs::path> scenes;
  find_scenes(root, 3, scenes);
  if (scenes.empty())
    throw input_error("there is no scene_gt.json or scene_gt_SENSOR.json in it or up to three levels below", root,
                      "name a BOP data set, one of its splits or scenes");
  const fs::path models = models_for(root, options.models);
  const nlohmann::json models_info = parsed(bop_models_info(models));
  try {
    for (const fs::path& scene : scenes) {
      const std::string suffix = suffix_for(scene, options.sensor);
      const BopFiles files{scene, suffix};
      const nlohmann::json truth = parsed(files.truth()), cameras = parsed(files.camera());
      const nlohmann::json info = fs::exists(files.info()) ? parsed(files.info()) : nlohmann::json::object();
      std::vector<std::pair<int, std::string>> images;
      for (const auto& [key, entries] : truth.items()) images.emplace_back(std::stoi(key), key);
      std::sort(images.begin(), images.end());
      for (const auto& [number, key] : images) {
        set.views.push_back(view_of(scene, suffix, key, cameras.at(key), truth.at(key),
                                    info.value(key, nlohmann::json::array()), options));
        set.world_stated = set.world_stated && states_world(cameras.at(key));
      }
    }
    for (const BopView& view : set.views)
      for (const BopPart& part : view.parts) set.models[part.object];
    for (auto& [object, path] : set.models) {
      path = bop_model_file(models, static_cast<std::size_t>(object)).string();
      if (!models_info.contains(std::to_string(object)))
        throw input_error("does not describe object " + std::to_string(object) + ", which scenes show",
                          bop_models_info(models).string(), "add its entry");
      if (!fs::is_regular_file(path)) throw input_error("is missing, and scenes show it", path, "add the model");
    }
    BIN_SCENES_ASSERT(each_is(set.views, [&](const BopView& view) {
      return each_is(view.parts, [&](const BopPart& part) { return set.models.count(part.object) > 0; });
    }));
    check_units(set, models_info, models);
  } catch (const nlohmann::json::exception& error) {
    throw input_error(std::string("is not as BOP has it: ") + error.what(), root,
                      "see docs/bop_datasets_format.md of bop_toolkit");
  } catch (const std::logic_error& error) {  // stoi
    throw input_error(std::string("an image is no number: ") + error.what(), root,
                      "see docs/bop_datasets_format.md of bop_toolkit");
  }
  return set;
}

}  // namespace bin_scenes
