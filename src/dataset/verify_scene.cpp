/// scene.json against its keys and limits, and images against labels and visible fractions. Only what the files state
/// is used.
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/core/types.hpp"
#include "bin_scenes/scene/validity.hpp"
#include "dataset/verify.hpp"
#include "dataset/whole_folders.hpp"
#include "output/boxes.hpp"
#include "output/png_reader.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <set>

namespace bin_scenes {

namespace fs = std::filesystem;

namespace {

std::string part_name(int id) {
  return "part " + std::to_string(id);
}

void verify_parts(const SceneFile& scene, const std::string& where, Findings& findings) {
  std::set<int> ids;
  for (const ScenePart& part : scene.parts) {
    ids.insert(part.id);
    if (!part.pose.finite()) continue;
    findings.expect(std::abs(part.pose.orientation.norm() - 1.0) < 1e-6, "part_turn", where,
                    part_name(part.id) + " has no unit quaternion");
    if (scene.bin.kind == Bin::Kind::box && part.state != PartState::escaped && part.state != PartState::fixed) {
      const Vec3 &size = scene.bin.inner_size, &p = part.pose.position;
      // A model's origin may lie beside the part; a part is smaller than the bin.
      const bool in =
          std::abs(p.x()) <= size.x() && std::abs(p.y()) <= size.y() && p.z() > -size.z() && p.z() < 3.0 * size.z();
      findings.expect(in, "part_place", where, part_name(part.id) + " lies far from the bin");
    }
    for (const auto& [sensor, fraction] : part.visible_fraction)
      findings.expect(fraction >= 0.0 && fraction <= 1.0, "fraction_range", where,
                      part_name(part.id) + " is visible to more than all or less than nothing");
  }
  const auto count = static_cast<int>(scene.parts.size());
  findings.expect(
      static_cast<int>(ids.size()) == count && (count == 0 || (*ids.begin() == 0 && *ids.rbegin() == count - 1)),
      "part_ids", where, "ids do not count from 0 to " + std::to_string(count - 1));
}

/// Of scene.json: x, y, width, height.
void verify_truth(const SceneSensor& sensor, const std::string& where, Findings& findings) {
  for (const PartTruth& part : *sensor.truth) {
    const std::size_t seen = part.visible_pixels, all = part.all_pixels;
    const double ratio = all ? static_cast<double>(seen) / static_cast<double>(all) : 0.0;
    findings.expect(seen <= all && std::abs(ratio - part.visible_fraction) < 1e-9, "truth_counts", where,
                    part_name(part.id) + ": counts and fraction do not agree");
    const std::array<int, 4>& box = part.visible_box;
    const bool none = box == std::array<int, 4>{-1, -1, -1, -1};
    const bool inside =
        box[0] >= 0 && box[1] >= 0 && box[0] + box[2] <= sensor.width && box[1] + box[3] <= sensor.height;
    findings.expect(seen == 0 ? none : inside, "truth_boxes", where,
                    part_name(part.id) + ": its box is not that of its pixels");
  }
}

void verify_images(const SceneFile& scene, const SceneSensor& sensor, const fs::path& folder, Findings& findings) {
  const std::string &name = sensor.name, where = (folder / name).string();
  const int width = sensor.width, height = sensor.height;
  const bool pinhole = sensor.model != "laser_line";
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

  const std::size_t parts = scene.parts.size();
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
  for (const PartTruth& part : *sensor.truth) {
    const Extent& e = extents.at(static_cast<std::size_t>(part.id));
    findings.expect(e.count == part.visible_pixels, "label_counts", where,
                    part_name(part.id) + " has " + std::to_string(e.count) + " pixels");
    findings.expect(e.xywh() == part.visible_box, "label_boxes", where,
                    part_name(part.id) + ": pixels do not fill the box");
  }
  const double scale = sensor.depth_scale, near = sensor.near, far = sensor.far;
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
  findings.expect(fs::exists(path / "request.yaml"), "request_there", where, "has no request.yaml");
  try {
    const SceneFile scene = read_scene_file((path / "scene.json").string(), Strictness::strict);
    findings.expect(true, "scene_json", where, "");
    findings.expect(scene.index == number, "scene_number", where, "scene.json has another number");
    findings.expect(scene.report.accepted && scene.report.reasons.empty(), "scene_accepted", where, "was not accepted");
    verify_parts(scene, where, findings);
    for (const SceneSensor& sensor : scene.sensors) {
      if (facts.wants("bop") || facts.wants("shards"))
        findings.expect(bop_misfit(sensor).empty(), "bop_pinhole", where,
                        "the lens of sensor '" + sensor.name + "' distorts, or it is none");
      if (!sensor.truth) continue;
      verify_truth(sensor, where, findings);
      if (facts.wants("png")) verify_images(scene, sensor, path, findings);
    }
  } catch (const std::exception& error) {  // of the file; ids and models that are none
    findings.expect(false, "scene_json", where, error.what());
  }
}

}  // namespace bin_scenes
