/// Writes a finished scene as one HTML page in which parts, bin, cameras and clouds can be turned and inspected. The
/// page contains all of its data and needs no network. With a trace, it also shows the motion of the parts and their
/// contacts over time.
#pragma once

#include "bin_scenes/config/scene_file.hpp"

#include <string>

namespace bin_scenes {

/// Places of the data that the folder of the scene does not contain.
struct ViewSources {
  std::string models;  ///< folder of the models; empty: models are searched (view_models.hpp)
  std::string trace;   ///< .jsonl file of `generate --trace`; empty: the page shows the final state only
};

/// Numbers for a message to the user: size of the page, and how many parts, clouds and trace samples it shows.
struct ViewResult {
  std::size_t bytes = 0, parts = 0, clouds = 0;
  std::size_t samples = 0;  ///< samples of the trace in the page
};

/// Writes the page of the scene in `folder` to `path`. Throws an environment Error without three.js, and an input Error
/// if models or files of the scene, or the trace, are missing or damaged.
ViewResult write_view(const SceneFile& scene, const std::string& folder, const ViewSources& sources,
                      const std::string& path);

}  // namespace bin_scenes
