/// A finished scene as one HTML page that needs no network.
#pragma once

#include "bin_scenes/config/scene_file.hpp"

#include <string>

namespace bin_scenes {

struct ViewResult {
  std::size_t bytes = 0, parts = 0, clouds = 0;
};

/// Writes the page of the scene in `folder` to `path`. Throws Error: without three.js, or if models or files of the
/// scene are missing or damaged. @param models  folder of the models; empty: they are looked for (view_models.hpp)
ViewResult write_view(const SceneFile& scene, const std::string& folder, const std::string& models,
                      const std::string& path);

}  // namespace bin_scenes
