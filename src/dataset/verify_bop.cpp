#include "bin_scenes/core/error.hpp"
#include "bin_scenes/core/types.hpp"
#include "core/read_file.hpp"
#include "dataset/extent.hpp"
#include "dataset/verify.hpp"
#include "output/png_reader.hpp"
#include "output/tiff.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>
#include <optional>
#include <set>

namespace bin_scenes {

namespace fs = std::filesystem;
using Json = nlohmann::json;

namespace {

std::string six_digits(std::size_t number) {
  char text[24];
  std::snprintf(text, sizeof text, "%06zu", number);
  return text;
}

Mat3 matrix_of(const Json& rows) {
  Mat3 m;
  for (int i = 0; i < 9; ++i) m(i / 3, i % 3) = rows.at(static_cast<std::size_t>(i));
  return m;
}
Vec3 vector_of(const Json& json) {
  return Vec3(json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>());
}
Pose pose_of(const Json& json) {
  const auto q = json.at("orientation_xyzw").get<std::array<double, 4>>();
  return {vector_of(json.at("position")), Quat(q[3], q[0], q[1], q[2])};
}

std::optional<Json> json_in(const fs::path& path) {
  if (!fs::is_regular_file(path)) return std::nullopt;
  const Json json = Json::parse(read_file(path.string()), nullptr, false);
  return json.is_object() ? std::optional<Json>(json) : std::nullopt;
}

/// BOP has x, y, and last pixel less first.
bool near_box(const Json& box, const Extent& e, int tolerance) {
  const std::array<int, 4> mine = {e.left, e.top, e.right - e.left, e.bottom - e.top};
  for (std::size_t i = 0; i < 4; ++i)
    if (std::abs(box.at(i).get<int>() - mine[i]) > tolerance) return false;
  return true;
}

/// What the visible masks of an image tell together.
struct Owners {
  std::vector<std::uint16_t> part;  ///< by pixel: the last one whose mask has it, id + 1
  std::size_t twice = 0;            ///< pixels in the masks of several parts
  void add(const LoadedImage& mask, int id) {
    part.resize(mask.samples.size());
    for (std::size_t i = 0; i < part.size(); ++i) {
      if (mask.samples[i] == 0) continue;
      twice += part[i] != 0;
      part[i] = static_cast<std::uint16_t>(id + 1);
    }
  }
};

void verify_masks(const fs::path& folder, const std::string& name, const Json& info, int id, int width, int height,
                  Owners& owners, Findings& findings) {
  const std::string where = (folder / "mask_visib" / name).string();
  LoadedImage seen, whole;
  try {
    seen = load_png(where);
    whole = load_png((folder / "mask" / name).string());
  } catch (const Error& error) {
    findings.expect(false, "bop_mask_there", error.where(), error.problem());
    return;
  }
  const bool sizes = seen.width == width && seen.height == height && whole.width == width && whole.height == height;
  if (!findings.expect(sizes, "bop_mask_there", where, "masks have another size than the image")) return;
  owners.add(seen, id);
  Extent visible, all;
  std::size_t beside = 0;
  for (int y = 0, i = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x, ++i) {
      const bool in_seen = seen.samples[static_cast<std::size_t>(i)] != 0,
                 in_whole = whole.samples[static_cast<std::size_t>(i)] != 0;
      if (in_seen) visible.add(x, y);
      if (in_whole) all.add(x, y);
      if (in_seen && !in_whole) ++beside;
    }
  }
  const std::size_t count = info.at("px_count_visib"), total = info.at("px_count_all");
  findings.expect(visible.count == count && all.count <= total, "bop_mask_count", where,
                  "has " + std::to_string(visible.count) + " pixels, " + std::to_string(count) + " are told");
  findings.expect(beside == 0, "bop_mask_inside", where, std::to_string(beside) + " pixels lie beside the silhouette");
  if (count > 0)
    findings.expect(near_box(info.at("bbox_visib"), visible, 1), "bop_mask_box", where,
                    "pixels do not fill bbox_visib");
}

/// The model's vertices in the image span its box, up to pixels whose centres no triangle covers.
void verify_projection(const Json& truth, const Json& info, const Json& camera, const BopModel& model,
                       const std::string& where, Findings& findings) {
  const Mat3 k = matrix_of(camera.at("cam_K")), turn = matrix_of(truth.at("cam_R_m2c"));
  const Vec3 shift = vector_of(truth.at("cam_t_m2c"));
  double left = 1e300, top = 1e300, right = -1e300, bottom = -1e300;
  for (const auto& v : model.vertices) {
    const Vec3 p = k * (turn * Vec3(v[0], v[1], v[2]) + shift);
    left = std::min(left, p.x() / p.z()), right = std::max(right, p.x() / p.z());
    top = std::min(top, p.y() / p.z()), bottom = std::max(bottom, p.y() / p.z());
  }
  const auto box = info.at("bbox_obj").get<std::array<int, 4>>();
  const auto close = [](double a, int b) { return std::abs(a - b) <= 2.5; };
  findings.expect(
      close(left, box[0]) && close(top, box[1]) && close(right, box[0] + box[2]) && close(bottom, box[1] + box[3]),
      "bop_reprojection", where, "the projected model does not fill bbox_obj");
}

/// True labels of the scene's sensor; none without output png.
std::optional<LoadedImage> true_labels(const fs::path& scene, const Json& sensor) {
  const fs::path path = scene / (sensor.at("name").get<std::string>() + "_truth_labels.png");
  try {
    return load_png(path.string());
  } catch (const Error&) {  // image_size tells it
    return std::nullopt;
  }
}

void verify_image(const fs::path& folder, const std::string& key, const Json& scene, const Json& camera,
                  const Json& truth, const Json& info, const std::map<int, BopModel>& models, Owners& owners,
                  Findings& findings) {
  const std::string where = folder.string() + ", image " + key;
  const Json& sensor = scene.at("sensors").at(std::stoul(key));
  const int width = sensor.at("width"), height = sensor.at("height");
  const std::string file = six_digits(std::stoul(key));
  const auto check_size = [&](const fs::path& path, const std::function<LoadedImage(const std::string&)>& load) {
    try {
      const LoadedImage image = load(path.string());
      findings.expect(image.width == width && image.height == height, "bop_image", path.string(),
                      "has another size than the sensor");
    } catch (const Error& error) {
      findings.expect(false, "bop_image", path.string(), error.problem());
    }
  };
  check_size(folder / "depth" / (file + ".png"), load_png);
  check_size(folder / "gray" / (file + ".tiff"), load_gray_tiff);
  std::map<int, const Json*> parts;
  for (const Json& part : scene.at("parts"))
    if (part.at("pose").is_object()) parts[part.at("id")] = &part;
  std::set<int> listed;
  for (const Json& entry : truth) listed.insert(entry.at("id").get<int>());
  bool all_there = truth.size() == parts.size() && info.size() == parts.size() && listed.size() == parts.size();
  for (const auto& [id, part] : parts) all_there &= listed.count(id) == 1;
  if (!findings.expect(all_there, "bop_parts", where, "does not list the parts of the scene")) return;
  const Pose camera_in_bin = pose_of(sensor.at("pose"));
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const int id = truth[i].at("id");
    const std::string part = where + ", part " + std::to_string(id);
    const Mat3 turn = matrix_of(truth[i].at("cam_R_m2c"));
    findings.expect((turn * turn.transpose() - Mat3::Identity()).norm() < 1e-6 && turn.determinant() > 0.0,
                    "bop_rotation", part, "cam_R_m2c is no rotation");
    const Pose pose = camera_in_bin.inverse() * pose_of(parts.at(id)->at("pose"));
    const bool same = (turn - pose.orientation.toRotationMatrix()).norm() < 1e-6 &&
                      (vector_of(truth[i].at("cam_t_m2c")) - 1e3 * pose.position).norm() < 1e-3;
    findings.expect(same, "bop_pose", part, "is not where scene.json has it");
    const auto model = models.find(truth[i].at("obj_id"));
    findings.expect(model != models.end(), "bop_object", part, "its object has no model");
    const std::size_t seen = info[i].at("px_count_visib"), all = info[i].at("px_count_all");
    const double ratio = all ? static_cast<double>(seen) / static_cast<double>(all) : 0.0;
    findings.expect(std::abs(ratio - info[i].at("visib_fract").get<double>()) < 1e-9 && seen <= all, "bop_fraction",
                    part, "visib_fract is not the ratio of the counts");
    const bool none = info[i].at("bbox_visib") == Json({-1, -1, -1, -1});
    findings.expect(none == (seen == 0), "bop_unseen", part, "bbox_visib and px_count_visib do not agree");
    verify_masks(folder, file + "_" + six_digits(i) + ".png", info[i], id, width, height, owners, findings);
    if (seen > 0 && model != models.end()) verify_projection(truth[i], info[i], camera, model->second, part, findings);
  }
}

/// Vertices of the binary PLY files that this project writes: three floats each, first in the file's data.
std::vector<std::array<double, 3>> read_vertices(const std::string& path) {
  const std::string bytes = read_file(path), end = "end_header\n", element = "element vertex ";
  const std::size_t count_at = bytes.find(element), data = bytes.find(end);
  std::vector<std::array<double, 3>> vertices;
  if (count_at == std::string::npos || data == std::string::npos) return vertices;
  const std::size_t count = std::stoul(bytes.substr(count_at + element.size(), 12));
  const char* at = bytes.data() + data + end.size();
  if (data + end.size() + count * 12 > bytes.size()) return vertices;
  for (std::size_t i = 0; i < count; ++i, at += 12) {
    float v[3];
    std::memcpy(v, at, sizeof v);
    vertices.push_back({static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])});
  }
  return vertices;
}

}  // namespace

std::map<int, BopModel> verify_models(const DataFolder& folder, Findings& findings) {
  const fs::path models = folder.root / "bop" / "models";
  std::map<int, BopModel> all;
  const auto info = json_in(models / "models_info.json");
  if (!findings.expect(info.has_value(), "model_info", models.string(), "models_info.json is missing or damaged"))
    return all;
  verify_files(models, findings);
  for (const auto& [key, model] : info->items()) {
    const std::string path = (models / ("obj_" + six_digits(std::stoul(key)) + ".ply")).string();
    const auto vertices = fs::exists(path) ? read_vertices(path) : std::vector<std::array<double, 3>>();
    Vec3 lower = Vec3::Constant(1e300), upper = -lower;
    for (const auto& v : vertices) {
      lower = lower.cwiseMin(Vec3(v[0], v[1], v[2]));
      upper = upper.cwiseMax(Vec3(v[0], v[1], v[2]));
    }
    const Vec3 size = upper - lower;
    const double diameter = model.value("diameter", 0.0);
    bool good = !vertices.empty() && diameter >= size.maxCoeff() * 0.999 && diameter <= size.norm() * 1.001 &&
                std::abs(model.value("size_x", 0.0) - size.x()) < 1e-3 * diameter &&
                std::abs(model.value("min_z", 0.0) - lower.z()) < 1e-3 * diameter;
    for (const Json& symmetry : model.value("symmetries_discrete", Json::array())) {
      Mat3 turn;
      for (int i = 0; i < 9; ++i) turn(i / 3, i % 3) = symmetry.at(static_cast<std::size_t>(4 * (i / 3) + i % 3));
      good &= (turn * turn.transpose() - Mat3::Identity()).norm() < 1e-6;
    }
    findings.expect(good, "model_info", path, "models_info does not fit the model");
    all[std::stoi(key)].vertices = vertices;
  }
  return all;
}

void verify_bop(const DataFolder& folder, const DataSetFacts& facts, std::size_t number, const Json& scene,
                const std::map<int, BopModel>& models, Findings& findings) {
  const fs::path path = folder.bop(facts, number);
  const auto camera = json_in(path / "scene_camera.json"), truth = json_in(path / "scene_gt.json"),
             info = json_in(path / "scene_gt_info.json");
  const bool good = camera && truth && info && camera->size() == truth->size() && truth->size() == info->size();
  if (!findings.expect(good, "bop_json", path.string(), "JSON files are missing, damaged or of different images"))
    return;
  try {
    for (const auto& [key, entry] : camera->items()) {
      Owners owners;
      verify_image(path, key, scene, entry, truth->at(key), info->at(key), models, owners, findings);
      if (facts.tolerance > 0.0 || owners.part.empty()) continue;
      const std::string where = path.string() + ", image " + key;
      findings.expect(owners.twice == 0, "bop_disjoint", where,
                      std::to_string(owners.twice) + " pixels are visible of several parts");
      if (!facts.wants("png")) continue;
      const auto labels = true_labels(folder.scene(number), scene.at("sensors").at(std::stoul(key)));
      if (labels)
        findings.expect(owners.part == labels->samples, "bop_labels", where, "masks are not where the true labels are");
    }
  } catch (const std::exception& error) {
    findings.expect(false, "bop_json", path.string(), error.what());
  }
}

}  // namespace bin_scenes
