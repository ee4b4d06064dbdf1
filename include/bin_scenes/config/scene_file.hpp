/// scene.json (format "bin_scenes/1") as a struct, read and written by the tables of its keys; docs/use/scene.md is
/// generated from the same tables.
#pragma once

#include "bin_scenes/scene/scene.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace bin_scenes {

/// What the camera of a sensor truly sees of a part. Boxes are x, y, width and height in pixels; four times -1 means
/// that nothing is visible.
struct PartTruth {
  int id = 0;
  Pose pose_in_camera;  ///< of the model frame in the sensor's optical frame (m)
  double visible_fraction = 0.0;
  std::array<int, 4> visible_box{}, whole_box{};
  std::size_t visible_pixels = 0, measured_pixels = 0, all_pixels = 0;
};

struct SceneSensor : Sensor {
  std::optional<std::vector<PartTruth>> truth;  ///< by part that is in the scene; none: no image was made
};

/// A model and how it was read; `sha256` is that of its file.
struct SceneModel : PartLine {};

struct SceneFile {
  std::uint64_t seed = 0;
  std::size_t index = 0;
  Bin bin;  ///< without surface and motion
  Vec3 gravity = Vec3(0.0, 0.0, -9.81);
  std::string request_sha256;
  std::vector<SceneSensor> sensors;  ///< of projector and laser only what the file holds
  std::vector<SceneModel> models;    ///< by part line
  std::vector<ScenePart> parts;
  Report report;
};

/// Which keys a file must have.
enum class Strictness {
  lenient,  ///< seed, index and parts: files of other programs and of earlier versions are read as well
  strict    ///< all that this version writes, but for the keys inside of `report`, which grow with each version
};

/// Numbers read back as the same bits; NaN is null, and so is the pose of a part that was never poured.
std::string scene_text(SceneFile scene);
/// The value of `report` in it.
std::string report_text(Report report);
/// Throws an input Error that names file and key.
SceneFile read_scene_file(const std::string& path, Strictness strictness = Strictness::lenient);
/// The same as a Scene, without the fields that only the file has.
Scene read_scene_json(const std::string& path);

/// docs/use/scene.md: every key of the file with its unit and meaning.
std::string scene_reference();

}  // namespace bin_scenes
