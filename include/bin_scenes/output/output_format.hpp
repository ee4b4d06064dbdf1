/// The table of the formats in which a scene can be written. The command line, plans, the completion in shells and the
/// store of finished scenes read from it which formats exist, what they need, and which files they write. A program can
/// add formats of its own.
#pragma once

#include "bin_scenes/config/formats.hpp"
#include "bin_scenes/grasp/scene_grasps.hpp"
#include "bin_scenes/part/loaded_request.hpp"
#include "bin_scenes/scene/scene.hpp"
#include "bin_scenes/sensor/range_image.hpp"

#include <functional>
#include <string>
#include <vector>

namespace bin_scenes {

/// The data from which a format writes a scene.
struct SceneOutput {
  const Scene& scene;
  const LoadedRequest& loaded;
  const std::vector<RangeImage>& images;
  const SceneGrasps* grasps = nullptr;  ///< null: no grasps were searched
  McapProfile mcap = McapProfile::ros1;
};

/// One format: its name and needs (SceneFormat), and how it is written.
struct OutputFormat : SceneFormat {
  /// Writes the files of this format into the folder of the scene. Empty if other code writes them: scene.json, which
  /// every scene has, and the folders of BOP.
  std::function<void(const std::string& folder, const SceneOutput&)> write = {};
  /// Returns the names of the files of this format that every finished scene of a request contains.
  std::function<std::vector<std::string>(const Request&)> files = {};
  /// Whether this build can write the format. Empty means that every build can.
  std::function<bool()> available = {};
};

/// Returns all formats, in the order of scene_formats().
const std::vector<OutputFormat>& output_formats();
/// Adds a format. A program calls it before it starts its first job. Throws an input Error if a format of that name
/// exists already.
void register_output_format(OutputFormat format);

}  // namespace bin_scenes
