/// The formats in which a scene can be written: one table, to which a program may add. The command line, plans, the
/// completion of shells and the store of finished scenes take everything they know of a format from it.
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

/// A scene that is to be written.
struct SceneOutput {
  const Scene& scene;
  const LoadedRequest& loaded;
  const std::vector<RangeImage>& images;
  const SceneGrasps* grasps = nullptr;  ///< null: none were searched
  McapProfile mcap = McapProfile::ros1;
};

struct OutputFormat : SceneFormat {
  /// Writes its files into the folder of the scene. Empty: they are written elsewhere (scene.json, which is always
  /// there, and BOP's folders).
  std::function<void(const std::string& folder, const SceneOutput&)> write = {};
  /// Names of the files that a finished scene has of it, beside those that only some scenes have.
  std::function<std::vector<std::string>(const Request&)> files = {};
  /// Whether this build can write it; empty: every build can.
  std::function<bool()> available = {};
};

/// In the order of scene_formats().
const std::vector<OutputFormat>& output_formats();
/// For the start of a program. Throws an input Error if the name is known.
void register_output_format(OutputFormat format);

}  // namespace bin_scenes
