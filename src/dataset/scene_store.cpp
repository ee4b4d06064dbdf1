/// Decides for each scene whether its folder is whole and of the same request, and writes new ones under hidden names.
/// BOP's models are written once.
#include "dataset/scene_store.hpp"

#include "bin_scenes/bop/bop_writer.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/core/temporary.hpp"
#include "bin_scenes/output/output_format.hpp"
#include "bin_scenes/output/scene_writer.hpp"
#include "bop/root.hpp"
#include "dataset/whole_folders.hpp"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

namespace bin_scenes {

namespace fs = std::filesystem;

namespace {

/// The index that folder() made the name of, if it did.
std::optional<std::size_t> index_of(const std::string& name) {
  const std::string prefix = "scene_";
  std::size_t index = 0;
  if (name.rfind(prefix, 0) != 0) return std::nullopt;
  std::from_chars(name.data() + prefix.size(), name.data() + name.size(), index);
  if (prefix + six_digits(index) != name) return std::nullopt;
  return index;
}

}  // namespace

SceneStore::SceneStore(const std::string& directory, const std::vector<std::string>& formats, McapProfile mcap,
                       bool verify)
    : directory_(directory), formats_(formats.begin(), formats.end()), mcap_(mcap), verify_(verify) {
  check_formats(formats_, "--formats");
  check_writable(directory);
  for (const bool accepted : {true, false}) {
    for (const char* below : {"", "bop", "bop/train"}) remove_leftovers((root(accepted) / below).string());
  }
}

bool SceneStore::needs_sensors() const {
  return needs(SceneFormat::Needs::sensors);
}
bool SceneStore::needs_grasps() const {
  return wants("grasps");
}
bool SceneStore::needs_gray() const {
  return std::any_of(formats_.begin(), formats_.end(),
                     [](const std::string& name) { return find_scene_format(name)->gray; });
}
bool SceneStore::needs_images() const {
  return needs_sensors() || needs(SceneFormat::Needs::images);
}
bool SceneStore::needs(SceneFormat::Needs what) const {
  return std::any_of(formats_.begin(), formats_.end(),
                     [&](const std::string& name) { return find_scene_format(name)->needs == what; });
}

fs::path SceneStore::root(bool accepted) const {
  return accepted ? fs::path(directory_) : fs::path(directory_) / "set_apart";
}

std::string SceneStore::folder(std::size_t index, bool accepted) const {
  return (root(accepted) / ("scene_" + six_digits(index))).string();
}

fs::path SceneStore::bop_folder(std::size_t index, bool accepted) const {
  return BopFolder{root(accepted) / "bop"}.scene("train", index);
}

bool SceneStore::complete(const std::string& folder, std::size_t index, const Request& request, bool accepted) const {
  const auto there = [](const fs::path& path) {
    std::error_code ignored;
    return fs::exists(path, ignored);
  };
  const fs::path base(folder);
  if (!whole(base, verify_)) return false;
  for (const OutputFormat& format : output_formats()) {
    if (!wants(format.name) || !format.files) continue;
    const std::vector<std::string> files = format.files(request);
    if (!std::all_of(files.begin(), files.end(), [&](const std::string& name) { return there(base / name); }))
      return false;
  }
  if (wants("mcap") && mcap_profile_in((base / "scene.mcap").string()) != name_of(mcap_)) return false;
  const fs::path bop = bop_folder(index, accepted);
  return !wants("bop") || (there(BopFiles{bop, ""}.truth()) && whole(bop, verify_));
}

std::set<std::size_t> SceneStore::indices(const Request& request) const {
  std::set<std::size_t> indices;
  for (const bool accepted : {true, false}) {
    std::error_code not_there;
    for (const auto& entry : fs::directory_iterator(root(accepted), not_there)) {
      const std::optional<std::size_t> index = index_of(entry.path().filename().string());
      if (index && *index >= request.first && *index - request.first < request.scenes) indices.insert(*index);
    }
  }
  return indices;
}

SceneStore::Found SceneStore::find(std::size_t index, const Request& request) const {
  for (const bool accepted : {true, false}) {
    const std::string path = folder(index, accepted);
    if (!fs::exists(fs::path(path) / "scene.json")) continue;
    const std::optional<SceneFile> scene = scene_in(path);
    if (!scene && has_manifest(path)) continue;  // ours, and damaged since
    if (!scene) {
      throw input_error("scene.json is there already, but it is cut off or damaged", path,
                        "remove this folder, and the scene is made anew");
    }
    if (scene->request_sha256 != request.text_sha256) {
      throw input_error("there is a scene of another request already", path,
                        "name another --out, or replace it with --overwrite");
    }
    if (complete(path, index, request, accepted)) return accepted ? Found::accepted : Found::set_apart;
  }
  return Found::nothing;
}

std::vector<std::string> SceneStore::reasons(std::size_t index) const {
  return read_scene_json((fs::path(folder(index, false)) / "scene.json").string()).report.reasons;
}

void SceneStore::prepare(Generator::Result& result, const Generator& generator) {
  const Scene& scene = result.scene;
  const bool accepted = scene.report.accepted;
  const auto folders = std::make_shared<WholeFolders>();
  folders->write(folder(scene.index, accepted), [&](const std::string& hidden) {
    write_scene_files(hidden, formats_, result, generator.loaded(), mcap_);
  });
  if (wants("bop")) {
    folders->write(bop_folder(scene.index, accepted), [&](const std::string& hidden) {
      write_bop(hidden, scene, generator.loaded().parts, result.images);
    });
  }
  result.images.clear();  // they are in files now, and a scene may wait long for its turn
  const std::lock_guard<std::mutex> lock(mutex_);
  prepared_[scene.index] = folders;
}

void SceneStore::commit(const Generator::Result& result, const Request& request, const Generator& generator) {
  const Scene& scene = result.scene;
  const bool accepted = scene.report.accepted;
  if (wants("bop") && models_written_.count(accepted) == 0) {
    const LoadedRequest& loaded = generator.loaded();
    std::vector<PartModelPtr> objects;
    for (std::size_t line = 0; line < loaded.parts.size(); ++line)
      if (!loaded.request.parts[line].distractor) objects.push_back(loaded.parts[line]);
    WholeFolders models;
    models.write(BopFolder{root(accepted) / "bop"}.models(),
                 [&](const std::string& hidden) { write_bop_models(hidden, objects); });
    models.commit();
    models_written_.insert(accepted);
  }

  // What an earlier scene of this index left behind, on either side, shows another scene.
  std::error_code ignored;
  const std::optional<SceneFile> earlier = scene_in(folder(scene.index, accepted));
  const bool same = earlier && earlier->request_sha256 == request.text_sha256;
  std::shared_ptr<WholeFolders> folders;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    folders = prepared_.at(scene.index);
    prepared_.erase(scene.index);
  }
  folders->commit();
  if (!wants("bop") && !same) fs::remove_all(bop_folder(scene.index, accepted), ignored);
  fs::remove_all(folder(scene.index, !accepted), ignored);
  fs::remove_all(bop_folder(scene.index, !accepted), ignored);
}

}  // namespace bin_scenes
