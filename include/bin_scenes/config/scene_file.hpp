/// scene.json (format "bin_scenes/1") as a struct. The file is read and written by the tables of its keys, from which
/// docs/use/scene.md is generated as well. output/scene_writer.hpp fills the struct from a Scene and its images.
#pragma once

#include "bin_scenes/scene/scene.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace bin_scenes {

/// What the camera of a sensor truly sees of a part. A box is {x, y, width, height} in pixels; {-1, -1, -1, -1} means
/// that nothing is visible.
struct PartTruth {
  int id = 0;
  Pose pose_in_camera;  ///< from the model frame to the optical frame of the sensor (m)
  double visible_fraction = 0.0;
  std::array<int, 4> visible_box{}, whole_box{};
  std::size_t visible_pixels = 0, measured_pixels = 0, all_pixels = 0;
};

/// A sensor in scene.json.
struct SceneSensor : Sensor {
  /// One entry for each part that is in the scene; none if no image was made.
  std::optional<std::vector<PartTruth>> truth;
};

/// A model file with the options with which it was read, and its digest.
struct SceneModel : PartLine {};

/// The contents of one scene.json.
struct SceneFile {
  std::uint64_t seed = 0;
  std::size_t index = 0;
  Bin bin;  ///< without surface and motion
  Table table;
  Vec3 gravity = Vec3(0.0, 0.0, -9.81);
  std::string request_sha256;
  std::vector<SceneSensor> sensors;  ///< of projector and laser, only the values that the file contains
  std::vector<SceneModel> models;    ///< by part line
  std::vector<ScenePart> parts;
  Report report;
};

/// Which keys a file must have.
enum class Strictness {
  lenient,  ///< only seed, index and parts are required, so that files of other programs and of earlier versions can be
            ///< read
  strict    ///< all keys that this version writes are required, except those within `report`, to which new versions add
            ///< keys
};

/// Returns the text of scene.json. Numbers are written so that reading restores the same bits. NaN is written as null,
/// and so is the pose of a part that was never poured.
std::string scene_text(SceneFile scene);
/// Returns the text of the value of `report` in that file.
std::string report_text(Report report);
/// Reads a scene.json. Throws an input Error that names the file and the key.
SceneFile read_scene_file(const std::string& path, Strictness strictness = Strictness::lenient);
/// Reads a scene.json as a Scene, without the fields that only the file has. Throws as read_scene_file().
Scene read_scene_json(const std::string& path);

/// Returns the text of docs/use/scene.md, which lists every key of the file with its unit and meaning.
std::string scene_reference();

}  // namespace bin_scenes
