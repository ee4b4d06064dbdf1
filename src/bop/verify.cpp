/// BOP's files against scene.json and against their own pictures: poses, boxes, masks, counts, models. The pixels of
/// masks are counted anew.
#include "bop/verify.hpp"

#include "bin_scenes/config/request_reader.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/core/types.hpp"
#include "bin_scenes/sensor/calibration.hpp"
#include "bin_scenes/sensor/resolve.hpp"
#include "bop/files.hpp"
#include "bop/json_file.hpp"
#include "output/png_reader.hpp"
#include "output/tiff.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <set>

namespace bin_scenes {

namespace fs = std::filesystem;
using StoredJson = nlohmann::json;

namespace {

Mat3 matrix_of(const StoredJson& rows) {
  Mat3 m;
  for (int i = 0; i < 9; ++i) m(i / 3, i % 3) = rows.at(static_cast<std::size_t>(i));
  return m;
}
Vec3 vector_of(const StoredJson& json) {
  return Vec3(json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>());
}
Mat3 matrix_of(const std::vector<double>& k) {
  Mat3 m;
  for (int i = 0; i < 9; ++i) m(i / 3, i % 3) = k.at(static_cast<std::size_t>(i));
  return m;
}

/// BOP has x, y, and last pixel less first.
bool near_box(const StoredJson& box, const Extent& e, int tolerance) {
  const std::array<int, 4> mine = {e.left, e.top, e.right - e.left, e.bottom - e.top};
  for (std::size_t i = 0; i < 4; ++i)
    if (std::abs(box.at(i).get<int>() - mine[i]) > tolerance) return false;
  return true;
}

/// What the visible masks of an image say together.
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

/// The camera in whose image boxes are given.
struct BoxCamera {
  Mat3 k;
  Pose given_in_it;  ///< frame of the camera that scene.json states
};

/// One image of a scene: what its files say, and where they lie.
struct ImageFiles {
  fs::path folder;
  BopPlace place;
  const SceneSensor& sensor;
  const StoredJson &camera, &truth, &info;
  BoxCamera box_camera;
  const StoredJson* annotations;        ///< of scene_gt_coco.json; null: the layout has none
  const BopMasks* visible_run_lengths;  ///< null: masks are PNG files
  const BopMasks* whole_run_lengths;

  BopFiles files() const { return {folder, place.suffix}; }
  std::string name() const { return folder.string() + ", image " + std::to_string(place.image) + place.suffix; }
};

/// The annotation of a part states what its visible mask and scene_gt state.
void verify_annotation(const ImageFiles& image, std::size_t entry, const LoadedImage& seen,
                       const StoredJson& annotation, const std::string& where, Findings& findings) {
  MaskBox mask{0, 0, seen.width, seen.height, {}};
  for (const std::uint16_t sample : seen.samples) mask.inside.push_back(sample != 0);
  const bool good = annotation.at("category_id") == image.truth[entry].at("obj_id") &&
                    annotation.at("area") == image.info[entry].at("px_count_visib") &&
                    annotation.at("ignore") == (image.info[entry].at("visib_fract") < bop_least_visible) &&
                    annotation.at("segmentation").at("counts") == run_lengths(mask, seen.width, seen.height);
  findings.expect(good, "bop_coco", where, "scene_gt_coco states another object or mask");
}

/// From run lengths if there are such, otherwise from a PNG file.
LoadedImage mask_from(const BopMasks* run_lengths, std::size_t entry, const std::string& path) {
  if (!run_lengths) return load_png(path);
  const std::optional<BinaryImage> mask = run_lengths->of(entry);
  if (!mask) throw input_error("is missing", run_lengths->place(entry), "make the scene anew");
  LoadedImage image;
  image.width = mask->width, image.height = mask->height;
  image.samples.assign(mask->inside.begin(), mask->inside.end());
  return image;
}

void verify_masks(const ImageFiles& image, std::size_t entry, const StoredJson* annotation, Owners& owners,
                  Findings& findings) {
  const std::string where = image.files().mask("mask_visib", image.place.image, entry).string();
  const StoredJson& info = image.info[entry];
  const int id = image.truth[entry].at("id"), width = image.sensor.width, height = image.sensor.height;
  LoadedImage seen, whole;
  try {
    seen = mask_from(image.visible_run_lengths, entry, where);
    whole = mask_from(image.whole_run_lengths, entry, image.files().mask("mask", image.place.image, entry).string());
  } catch (const Error& error) {
    findings.expect(false, "bop_mask_there", error.where(), error.problem());
    return;
  }
  const bool sizes = seen.width == width && seen.height == height && whole.width == width && whole.height == height;
  if (!findings.expect(sizes, "bop_mask_there", where, "masks have another size than the image")) return;
  owners.add(seen, id);
  if (annotation) verify_annotation(image, entry, seen, *annotation, where, findings);
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
                  "has " + std::to_string(visible.count) + " pixels, " + std::to_string(count) + " are stated");
  findings.expect(beside == 0, "bop_mask_inside", where, std::to_string(beside) + " pixels lie beside the silhouette");
  if (count > 0)
    findings.expect(near_box(info.at("bbox_visib"), visible, 1), "bop_mask_box", where,
                    "pixels do not fill bbox_visib");
}

/// The model's vertices in the image span its box, up to pixels whose centres no triangle covers.
void verify_projection(const StoredJson& truth, const StoredJson& info, const ImageFiles& image, const BopModel& model,
                       const std::string& where, Findings& findings) {
  const Mat3 stated_rotation = matrix_of(truth.at("cam_R_m2c"));
  const Mat3 turn = image.box_camera.given_in_it.orientation.toRotationMatrix() * stated_rotation;
  const Vec3 shift = image.box_camera.given_in_it.orientation * vector_of(truth.at("cam_t_m2c")) +
                     1e3 * image.box_camera.given_in_it.position;
  double left = 1e300, top = 1e300, right = -1e300, bottom = -1e300;
  for (const auto& v : model.vertices) {
    const Vec3 p = image.box_camera.k * (turn * Vec3(v[0], v[1], v[2]) + shift);
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
std::optional<LoadedImage> true_labels(const fs::path& scene, const Sensor& sensor) {
  const fs::path path = scene / (sensor.name + "_truth_labels.png");
  try {
    return load_png(path.string());
  } catch (const Error&) {  // image_size reports it
    return std::nullopt;
  }
}

/// scene_camera against the sensor of scene.json.
void verify_camera(const ImageFiles& image, Findings& findings) {
  const StoredJson& stated = image.camera;
  const Pose bin_in_camera = image.sensor.pose->inverse();
  const double scale = 1e3 * image.sensor.depth_scale;
  const bool same = (matrix_of(stated.at("cam_K")) - matrix_of(image.sensor.k)).norm() < 1e-6 &&
                    std::abs(stated.at("depth_scale").get<double>() - scale) < 1e-9 * scale &&
                    (matrix_of(stated.at("cam_R_w2c")) - bin_in_camera.orientation.toRotationMatrix()).norm() < 1e-6 &&
                    (vector_of(stated.at("cam_t_w2c")) - 1e3 * bin_in_camera.position).norm() < 1e-3;
  findings.expect(same, "bop_camera", image.name(), "scene_camera is not that of the sensor in scene.json");
}

void verify_pictures(const ImageFiles& image, Findings& findings) {
  for (const BopPlace::File& file : image.place.files) {
    const std::string path = (image.folder / image.place.path_of(file)).string();
    try {
      if (file.extension == ".jpg") {
        findings.expect(fs::is_regular_file(path), "bop_image", path, "is missing");
        continue;
      }
      const LoadedImage picture = file.extension == ".png" ? load_png(path) : load_tiff(path);
      findings.expect(picture.width == image.sensor.width && picture.height == image.sensor.height &&
                          picture.channels == (file.modality == "rgb" ? 3 : 1) &&
                          picture.bits == (file.modality == "depth" ? 16 : 8),
                      "bop_image", path, "has another size than the sensor, or other channels than its modality");
    } catch (const Error& error) {
      findings.expect(false, "bop_image", path, error.problem());
    }
  }
}

/// Annotations of an image in the order of scene_gt, which skips what is not seen.
std::vector<const StoredJson*> annotations_of(const ImageFiles& image, Findings& findings) {
  std::vector<const StoredJson*> by_entry(image.info.size(), nullptr);
  if (!image.annotations) return by_entry;
  std::vector<const StoredJson*> here;
  for (const StoredJson& annotation : image.annotations->at("annotations"))
    if (annotation.at("image_id") == image.place.image) here.push_back(&annotation);
  std::vector<std::size_t> seen;
  for (std::size_t i = 0; i < image.info.size(); ++i)
    if (image.info[i].at("px_count_visib") > 0) seen.push_back(i);
  if (findings.expect(here.size() == seen.size(), "bop_coco", image.name(),
                      "scene_gt_coco has " + std::to_string(here.size()) + " annotations for " +
                          std::to_string(seen.size()) + " visible parts"))
    for (std::size_t i = 0; i < seen.size(); ++i) by_entry[seen[i]] = here[i];
  return by_entry;
}

void verify_image(const ImageFiles& image, const SceneFile& scene, const std::map<int, BopModel>& models,
                  Owners& owners, Findings& findings) {
  const std::string where = image.name();
  const StoredJson &truth = image.truth, &info = image.info;
  verify_camera(image, findings);
  verify_pictures(image, findings);
  std::map<int, const ScenePart*> parts;
  for (const ScenePart& part : scene.parts)
    if (part.pose.finite() && !part.distractor) parts[part.id] = &part;
  std::set<int> listed;
  for (const StoredJson& entry : truth) listed.insert(entry.at("id").get<int>());
  bool all_there = truth.size() == parts.size() && info.size() == parts.size() && listed.size() == parts.size();
  for (const auto& [id, part] : parts) all_there &= listed.count(id) == 1;
  if (!findings.expect(all_there, "bop_parts", where, "does not list the parts of the scene")) return;
  const std::vector<const StoredJson*> annotations = annotations_of(image, findings);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const int id = truth[i].at("id");
    const std::string part = where + ", part " + std::to_string(id);
    const Mat3 turn = matrix_of(truth[i].at("cam_R_m2c"));
    findings.expect((turn * turn.transpose() - Mat3::Identity()).norm() < 1e-6 && turn.determinant() > 0.0,
                    "bop_rotation", part, "cam_R_m2c is no rotation");
    const Pose pose = image.sensor.pose->inverse() * parts.at(id)->pose;
    const bool same = (turn - pose.orientation.toRotationMatrix()).norm() < 1e-6 &&
                      (vector_of(truth[i].at("cam_t_m2c")) - 1e3 * pose.position).norm() < 1e-3;
    findings.expect(same, "bop_pose", part, "is not where scene.json has it");
    const auto model = models.find(truth[i].at("obj_id"));
    findings.expect(model != models.end(), "bop_object", part, "its object has no model");
    const std::size_t seen = info[i].at("px_count_visib"), all = info[i].at("px_count_all");
    const double ratio = all ? static_cast<double>(seen) / static_cast<double>(all) : 0.0;
    findings.expect(std::abs(ratio - info[i].at("visib_fract").get<double>()) < 1e-9 && seen <= all, "bop_fraction",
                    part, "visib_fract is not the ratio of the counts");
    const bool none = info[i].at("bbox_visib") == StoredJson({-1, -1, -1, -1});
    findings.expect(none == (seen == 0), "bop_unseen", part, "bbox_visib and px_count_visib do not agree");
    verify_masks(image, i, annotations[i], owners, findings);
    if (seen > 0 && model != models.end()) verify_projection(truth[i], info[i], image, model->second, part, findings);
  }
}

/// The JSON files of one sensor.
struct StoredFiles {
  std::optional<StoredJson> camera, truth, info, coco;
};

StoredFiles files_of(const BopFiles& stored, bool coco, std::size_t images, Findings& findings) {
  const std::string where = stored.scene.string() + stored.suffix;
  StoredFiles files{json_map_in<StoredJson>(stored.camera()),
                    json_map_in<StoredJson>(stored.truth()),
                    json_map_in<StoredJson>(stored.info()),
                    {}};
  const bool good = files.camera && files.truth && files.info && files.camera->size() == images &&
                    files.truth->size() == images && files.info->size() == images;
  if (!findings.expect(good, "bop_json", where, "JSON files are missing, damaged or of different images")) return {};
  if (coco) {
    files.coco = json_map_in<StoredJson>(stored.coco());
    findings.expect(files.coco.has_value() && files.coco->contains("annotations") &&
                        files.coco->value("images", StoredJson::array()).size() == images,
                    "bop_coco", where, "scene_gt_coco is missing, damaged or of other images");
  }
  return files;
}

/// The sensors as they truly are. Errors of their calibration, which scene.json does not contain, are drawn again from
/// request.yaml; its models may lie elsewhere now, and what is not needed is left out.
std::vector<Sensor> true_devices(const fs::path& folder, const SceneFile& scene) {
  const std::string request = fs::absolute(folder / "request.yaml").string();
  std::vector<Override> overrides = {"parts=[{model: " + StoredJson(request).dump() + "}]", "bin={none: true}",
                                     "pour={}"};
  for (std::size_t i = 0; i < scene.sensors.size(); ++i) {
    const std::string sensor = "sensors[" + std::to_string(i) + "].";
    overrides.emplace_back(sensor + "preset=''");
    if (scene.sensors[i].model == "image") overrides.emplace_back(sensor + "lamps=[]");
  }
  Request stated = read_request(request, overrides);
  for (std::size_t i = 0; i < stated.sensors.size(); ++i) {
    stated.sensors[i].pose = scene.sensors.at(i).pose;
    stated.sensors[i] = resolved(stated.sensors[i], stated.bin);
  }
  std::vector<Sensor> devices;
  for (std::size_t i = 0; i < stated.sensors.size(); ++i) devices.push_back(true_device(stated.sensors, i, scene.seed));
  return devices;
}

/// By sensor. Boxes of masks that follow measured depth are those of the camera that is stated; those of true masks are
/// the true device's.
std::vector<BoxCamera> cameras_of(const BopFolder& folder, const BopScene& scene) {
  std::vector<BoxCamera> cameras;
  const std::vector<SceneSensor>& sensors = scene.file.sensors;
  for (const Sensor& sensor : sensors) cameras.push_back({matrix_of(sensor.k), Pose()});
  const auto is_exact = [](const Sensor& sensor) { return sensor.model == "ideal"; };
  if (folder.tolerance > 0.0 || std::all_of(sensors.begin(), sensors.end(), is_exact)) return cameras;
  const std::vector<Sensor> devices = true_devices(scene.own, scene.file);
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    cameras[i].k = matrix_of(devices.at(i).k);
    cameras[i].given_in_it = devices[i].pose->inverse() * *sensors[i].pose;
  }
  return cameras;
}

}  // namespace

void verify_bop(const BopFolder& folder, const BopScene& scene, const std::map<int, BopModel>& models,
                Findings& findings) {
  const fs::path& path = scene.bop;
  try {
    const std::vector<SceneSensor>& sensors = scene.file.sensors;
    const std::vector<BopPlace> places = bop_places(folder.layout, {sensors.begin(), sensors.end()}, scene.split);
    const std::vector<BoxCamera> cameras = cameras_of(folder, scene);
    std::map<std::string, std::size_t> images;  // by suffix
    for (const BopPlace& place : places) ++images[place.suffix];
    std::map<std::string, StoredFiles> files;
    const bool coco = folder.layout.kind == BopLayout::Kind::industrial || folder.run_lengths;
    for (const auto& [suffix, count] : images) files[suffix] = files_of({path, suffix}, coco, count, findings);
    for (std::size_t n = 0; n < places.size(); ++n) {
      const BopPlace& place = places[n];
      const StoredFiles& of_sensor = files.at(place.suffix);
      if (!of_sensor.camera) continue;
      const std::string key = std::to_string(place.image);
      BopView view;
      view.scene = path, view.suffix = place.suffix, view.image = static_cast<int>(place.image);
      std::optional<BopMasks> visible, whole;
      if (folder.run_lengths) visible.emplace(view, "mask_visib"), whole.emplace(view, "mask");
      const ImageFiles image{path,
                             place,
                             sensors.at(n),
                             of_sensor.camera->at(key),
                             of_sensor.truth->at(key),
                             of_sensor.info->at(key),
                             cameras[n],
                             of_sensor.coco ? &*of_sensor.coco : nullptr,
                             visible ? &*visible : nullptr,
                             whole ? &*whole : nullptr};
      Owners owners;
      verify_image(image, scene.file, models, owners, findings);
      if (folder.tolerance > 0.0 || owners.part.empty()) continue;
      findings.expect(owners.twice == 0, "bop_disjoint", image.name(),
                      std::to_string(owners.twice) + " pixels are visible of several parts");
      if (!scene.has_labels) continue;
      const auto labels = true_labels(scene.own, image.sensor);
      if (labels)
        findings.expect(owners.part == labels->samples, "bop_labels", image.name(),
                        "masks are not where the true labels are");
    }
  } catch (const std::exception& error) {
    findings.expect(false, "bop_json", path.string(), error.what());
  }
}

void verify_bop_root(const BopFolder& folder, Findings& findings) {
  for (const auto& [name, text] : bop_root_files(folder)) {
    const fs::path path = folder.root / name;
    findings.expect(fs::is_regular_file(path) && read_file(path.string()) == text, "bop_root", path.string(),
                    "is missing, or not what the scenes imply");
  }
}

}  // namespace bin_scenes
