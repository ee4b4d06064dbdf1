#include "page/view_models.hpp"

#include "bin_scenes/core/error.hpp"
#include "bin_scenes/mesh/mesh_loader.hpp"
#include "config/paths.hpp"

#include <filesystem>
#include <vector>

namespace bin_scenes {

namespace fs = std::filesystem;

namespace {

std::vector<fs::path> candidates(const std::string& written, const std::string& folder, const std::string& models) {
  const fs::path path(written), name = path.filename();
  std::vector<fs::path> all;
  if (!models.empty()) all = {fs::path(models) / path, fs::path(models) / name};
  const auto search_in = [&](const fs::path& place) {
    all.insert(all.end(), {place / path, place / name, place / "models" / name});
  };
  search_in(fs::current_path());
  fs::path above = fs::weakly_canonical(folder);
  for (search_in(above); above.has_relative_path(); search_in(above)) above = above.parent_path();
  if (written.rfind("package://", 0) == 0) {
    try {
      all.emplace_back(config::resolve_file(written, folder, PathRules(), "models"));
    } catch (const Error&) {  // no such package: the error below names the remedy
    }
  }
  return all;
}

ModelFile find_file(const std::string& written, const std::string& sha256, const std::string& folder,
                    const std::string& models) {
  std::string other;
  for (const fs::path& path : candidates(written, folder, models)) {
    std::error_code missing;
    if (!fs::is_regular_file(path, missing)) continue;
    ModelFile file = read_model_file(path.string());
    if (sha256.empty() || file.sha256 == sha256) return file;
    if (other.empty()) other = path.string();
  }
  if (!other.empty())
    throw input_error("has changed since the scene was made", other,
                      "name the folder of the model as it was: --models DIR");
  throw input_error("the model '" + written + "' is not found beside or above the scene" +
                        (models.empty() ? "" : ", nor in " + models),
                    folder, "name the folder of the models: --models DIR");
}

}  // namespace

Mesh find_model(const SceneModel& model, const Bin& bin, const std::string& folder, const std::string& models) {
  const ModelFile file = find_file(model.model, model.sha256, folder, models);
  const LoadOptions options = load_options(model);
  Mesh mesh = load_mesh(file, options).mesh;
  try {
    check_plausible_size(mesh, bin, file.path, options.unit);
  } catch (const Error&) {  // it was poured all the same
    throw input_error("does not fit the bin in metres, and scene.json, which an earlier version wrote, states no unit",
                      file.path, "make the scene anew: generate --overwrite");
  }
  return mesh;
}

std::string find_model_file(const SceneModel& model, const std::string& folder, const std::string& models) {
  return find_file(model.model, model.sha256, folder, models).path;
}

Mesh find_bin(const Bin& bin, const std::string& folder, const std::string& models) {
  LoadOptions options;
  options.unit = bin.unit;
  options.require_closed = false;
  return load_mesh(find_file(bin.mesh, bin.mesh_sha256, folder, models), options).mesh;
}

}  // namespace bin_scenes
