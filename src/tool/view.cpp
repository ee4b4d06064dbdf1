/// The command `view`.
#include "page/view.hpp"

#include "bin_scenes/core/error.hpp"
#include "tool/commands.hpp"
#include "tool/progress_bar.hpp"

#include <cstdio>
#include <filesystem>

namespace bin_scenes {

namespace {

namespace fs = std::filesystem;

/// scene.json of a scene that was named by its folder or by this file.
fs::path scene_file(const std::string& named) {
  std::error_code missing;
  const fs::path path = fs::is_directory(named, missing) ? fs::path(named) / "scene.json" : fs::path(named);
  if (!fs::is_regular_file(path, missing))
    throw input_error("there is no scene", path.string(),
                      "name a folder that holds a scene.json, as generate makes it");
  return path;
}

}  // namespace

int view(const ViewOptions& options) {
  const fs::path file = scene_file(options.scene);
  const std::string folder = file.has_parent_path() ? file.parent_path().string() : ".";
  const std::string path = options.out.empty() ? (fs::path(folder) / "view.html").string() : options.out;
  const SceneFile scene = read_scene_file(file.string(), Strictness::strict);
  ProgressBar bar;
  bar.stage(0.0, 1.0, "reading models and clouds");
  const ViewResult page = write_view(scene, folder, {options.models, options.trace}, path);
  bar.clear();
  const std::string samples = options.trace.empty() ? "" : std::to_string(page.samples) + " samples of the trace, ";
  std::printf("%s: %zu parts, %zu clouds, %s%.1f MB\n", path.c_str(), page.parts, page.clouds, samples.c_str(),
              static_cast<double>(page.bytes) / 1e6);
  if (page.clouds == 0)
    std::fprintf(stderr, "bin_scenes: no cloud, since %s\n",
                 scene.sensors.empty() ? "the scene has no sensors"
                                       : "no file of one is there (generate --formats json,png,ply)");
  return exit_done;
}

}  // namespace bin_scenes
