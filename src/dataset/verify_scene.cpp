/// scene.json against its keys and limits, and images against labels and visible fractions. Only what the files tell is
/// used.
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/core/types.hpp"
#include "bin_scenes/sensor/validity.hpp"
#include "dataset/extent.hpp"
#include "dataset/verify.hpp"
#include "dataset/whole_folders.hpp"
#include "output/png_reader.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <set>

namespace bin_scenes {

namespace fs = std::filesystem;
using Json = nlohmann::json;

namespace {

std::string name_of(const Json& part) {
  return "part " + std::to_string(part.at("id").get<int>());
}

void verify_parts(const Json& scene, const std::string& where, Findings& findings) {
  std::set<int> ids;
  const bool box = scene.at("bin").contains("inner_size");
  for (const Json& part : scene.at("parts")) {
    const int id = part.at("id");
    ids.insert(id);
    if (!part.at("pose").is_object()) continue;
    const auto q = part.at("pose").at("orientation_xyzw").get<std::array<double, 4>>();
    const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    findings.expect(std::abs(length - 1.0) < 1e-6, "part_turn", where, name_of(part) + " has no unit quaternion");
    const auto p = part.at("pose").at("position").get<std::array<double, 3>>();
    if (box && part.at("state") != "escaped") {
      const auto size = scene.at("bin").at("inner_size").get<std::array<double, 3>>();
      // A model's origin may lie beside the part; a part is smaller than the bin.
      const bool in = std::abs(p[0]) <= size[0] && std::abs(p[1]) <= size[1] && p[2] > -size[2] && p[2] < 3.0 * size[2];
      findings.expect(in, "part_place", where, name_of(part) + " lies far from the bin");
    }
    for (const auto& [sensor, fraction] : part.at("visible_fraction").items())
      findings.expect(fraction.is_number() && fraction >= 0.0 && fraction <= 1.0, "fraction_range", where,
                      name_of(part) + " is visible to more than all or less than nothing");
  }
  const auto count = static_cast<int>(scene.at("parts").size());
  findings.expect(
      static_cast<int>(ids.size()) == count && (count == 0 || (*ids.begin() == 0 && *ids.rbegin() == count - 1)),
      "part_ids", where, "ids do not count from 0 to " + std::to_string(count - 1));
}

/// Of scene.json: x, y, width, height.
std::array<int, 4> box_of(const Extent& e) {
  if (e.count == 0) return {-1, -1, -1, -1};
  return {e.left, e.top, e.right - e.left + 1, e.bottom - e.top + 1};
}

void verify_truth(const Json& sensor, const std::string& where, Findings& findings) {
  const int width = sensor.at("width"), height = sensor.at("height");
  for (const Json& part : sensor.at("truth")) {
    const std::size_t seen = part.at("px_count_visib"), all = part.at("px_count_all");
    const double ratio = all ? static_cast<double>(seen) / static_cast<double>(all) : 0.0;
    findings.expect(seen <= all && std::abs(ratio - part.at("visible_fraction").get<double>()) < 1e-9, "truth_counts",
                    where, name_of(part) + ": counts and fraction do not agree");
    const auto box = part.at("bbox_visib").get<std::array<int, 4>>();
    const bool none = box == std::array<int, 4>{-1, -1, -1, -1};
    const bool inside = box[0] >= 0 && box[1] >= 0 && box[0] + box[2] <= width && box[1] + box[3] <= height;
    findings.expect(seen == 0 ? none : inside, "truth_boxes", where,
                    name_of(part) + ": its box is not that of its pixels");
  }
}

bool is_pinhole(const Json& sensor) {
  return sensor.at("model") != "laser_line" && sensor.at("distortion") == Json({0.0, 0.0, 0.0, 0.0, 0.0});
}

void verify_images(const Json& scene, const Json& sensor, const fs::path& folder, Findings& findings) {
  const std::string name = sensor.at("name"), where = (folder / name).string();
  const int width = sensor.at("width"), height = sensor.at("height");
  const bool pinhole = sensor.at("model") != "laser_line";
  LoadedImage labels, measured, depth, validity;
  try {
    labels = load_png((folder / (name + "_truth_labels.png")).string());
    measured = load_png((folder / (name + "_labels.png")).string());
    depth = load_png((folder / (name + "_depth.png")).string());
    validity = load_png((folder / (name + "_validity.png")).string());
  } catch (const Error& error) {
    findings.expect(false, "image_size", error.where(), error.problem());
    return;
  }
  const bool sizes = labels.width == width && labels.height == height && depth.width == validity.width &&
                     depth.height == validity.height && measured.width == depth.width &&
                     measured.height == depth.height && (!pinhole || (depth.width == width && depth.height == height));
  if (!findings.expect(sizes, "image_size", where, "images have other sizes than the sensor")) return;

  const std::size_t parts = scene.at("parts").size();
  std::vector<Extent> extents(parts);
  std::size_t strange = 0;
  for (int y = 0, i = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x, ++i) {
      const std::uint16_t label = labels.samples[static_cast<std::size_t>(i)];
      if (label == 0) continue;
      if (label > parts) {
        ++strange;
        continue;
      }
      extents[label - 1u].add(x, y);
    }
  }
  findings.expect(strange == 0, "label_range", where, std::to_string(strange) + " pixels carry the label of no part");
  for (const Json& part : sensor.at("truth")) {
    const Extent& e = extents.at(part.at("id").get<std::size_t>());
    findings.expect(e.count == part.at("px_count_visib").get<std::size_t>(), "label_counts", where,
                    name_of(part) + " has " + std::to_string(e.count) + " pixels");
    findings.expect(box_of(e) == part.at("bbox_visib").get<std::array<int, 4>>(), "label_boxes", where,
                    name_of(part) + ": pixels do not fill the box");
  }
  const double scale = sensor.at("depth_scale"), near = sensor.at("near"), far = sensor.at("far");
  std::size_t outside = 0, codes = 0, mislabelled = 0;
  for (std::size_t i = 0; i < depth.samples.size(); ++i) {
    const double z = depth.samples[i] * scale;
    // Noise may carry a measurement over the ends of the range; more than a hundredth of it does not.
    if (depth.samples[i] != 0 && (z < 0.99 * near - scale || z > 1.01 * far + scale)) ++outside;
    if (validity.samples[i] > static_cast<int>(Validity::last) || (validity.samples[i] == 0) != (depth.samples[i] != 0))
      ++codes;
    const std::uint16_t label = measured.samples[i];
    // Profiles of a laser are no image of the camera: their labels are only compared with what can be.
    if (depth.samples[i] == 0 || !pinhole)
      mislabelled += depth.samples[i] == 0 ? label != 0 : label > parts;
    else
      mislabelled += label != labels.samples[i];
  }
  findings.expect(outside == 0, "depth_range", where, std::to_string(outside) + " depths are out of range");
  findings.expect(mislabelled == 0, "label_measured", where,
                  std::to_string(mislabelled) + " pixels of _labels.png differ from what is seen there");
  findings.expect(codes == 0, "validity_codes", where, std::to_string(codes) + " pixels have a wrong code");
}

}  // namespace

void verify_scene(const DataFolder& folder, const DataSetFacts& facts, std::size_t number, Findings& findings) {
  const fs::path path = folder.scene(number);
  const std::string where = path.string();
  const auto scene = scene_in(where);
  const bool good = scene && scene->is_object() && scene->value("format", Json()) == "bin_scenes/1";
  if (!findings.expect(good, "scene_json", where, "scene.json is missing, damaged or of another format")) return;
  findings.expect(fs::exists(path / "request.yaml"), "request_there", where, "has no request.yaml");
  try {
    findings.expect(scene->at("index") == number, "scene_number", where, "scene.json has another number");
    const Json& report = scene->at("report");
    findings.expect(report.at("accepted") == true && report.at("reasons").empty(), "scene_accepted", where,
                    "was not accepted");
    verify_parts(*scene, where, findings);
    for (const Json& sensor : scene->at("sensors")) {
      if (facts.wants("bop") || facts.wants("shards"))
        findings.expect(is_pinhole(sensor), "bop_pinhole", where,
                        "the lens of sensor '" + sensor.value("name", "") + "' distorts, or it is none");
      if (!sensor.contains("truth")) continue;
      verify_truth(sensor, where, findings);
      if (facts.wants("png")) verify_images(*scene, sensor, path, findings);
    }
  } catch (const std::exception& error) {  // of a key that is not there or has another type
    findings.expect(false, "scene_json", where, error.what());
  }
}

}  // namespace bin_scenes
