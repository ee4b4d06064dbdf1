#include "tool/scene_store.hpp"

#include "bin_scenes/core/error.hpp"
#include "bin_scenes/output/scene_writer.hpp"

#include <nlohmann/json.hpp>

#include <unistd.h>

#include <charconv>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>

namespace bin_scenes {

namespace fs = std::filesystem;

namespace {

std::string six_digits(std::size_t index) {
  char text[24];
  std::snprintf(text, sizeof(text), "%06zu", index);
  return text;
}

/// The index that folder() made the name of, if it did.
std::optional<std::size_t> index_of(const std::string& name) {
  const std::string prefix = "scene_";
  std::size_t index = 0;
  if (name.rfind(prefix, 0) != 0) return std::nullopt;
  std::from_chars(name.data() + prefix.size(), name.data() + name.size(), index);
  if (prefix + six_digits(index) != name) return std::nullopt;
  return index;
}

void make_directory(const fs::path& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error)
    throw environment_error("cannot be made: " + error.message(), path.string(), "check permissions and space");
}

void check_formats(const std::set<std::string>& formats) {
  for (const std::string& format : formats) {
    if (format != "json" && format != "pcd" && format != "png" && format != "bop" && format != "bag") {
      throw input_error("unknown format '" + format + "'", "--formats", "json, pcd, png, bop or bag");
    }
  }
  if (formats.count("pcd") && !pcd_supported()) {
    throw environment_error("this build has no PCL and writes no PCD", "--formats", "build with -DBIN_SCENES_PCL=ON");
  }
  if (formats.count("bag") && !bag_writer()) {
    throw environment_error("this build has no ROS and writes no bags", "--formats", "build with -DBIN_SCENES_ROS=ON");
  }
}

/// Before hours of simulation, not after them. The nearest directory that exists has to take new files.
void check_writable(const fs::path& directory) {
  fs::path place = fs::absolute(directory).lexically_normal();
  std::error_code error;
  while (!fs::exists(place, error) && place.has_relative_path()) place = place.parent_path();
  if (!fs::is_directory(place, error)) {
    throw environment_error("'" + place.string() + "' is not a directory", directory.string(),
                            "name a directory for --out");
  }
  if (::access(place.c_str(), W_OK | X_OK) != 0) {
    throw environment_error("'" + place.string() + "' cannot be written", directory.string(),
                            "check permissions, or name another directory for --out");
  }
}

/// `fill` writes into a hidden folder, which takes its name once it is whole. Errors name the folder it was to become.
template <typename Fill>
void write_whole(const std::string& target, const Fill& fill) {
  Temporary whole(target);
  try {
    fill(whole.path());
  } catch (const Error& error) {
    std::string where = error.where();
    if (where.rfind(whole.path(), 0) == 0) where.replace(0, whole.path().size(), target);
    throw Error(error.kind(), error.problem(), where, error.remedy());
  }
  whole.commit();
}

}  // namespace

SceneStore::SceneStore(const std::string& directory, const std::vector<std::string>& formats)
    : directory_(directory), formats_(formats.begin(), formats.end()) {
  check_formats(formats_);
  check_writable(directory);
}

bool SceneStore::needs_images() const {
  return formats_.size() > formats_.count("json");
}

fs::path SceneStore::root(bool accepted) const {
  return accepted ? fs::path(directory_) : fs::path(directory_) / "set_apart";
}

std::string SceneStore::folder(std::size_t index, bool accepted) const {
  return (root(accepted) / ("scene_" + six_digits(index))).string();
}

bool SceneStore::complete(const std::string& folder, std::size_t index, const Request& request, bool accepted) const {
  const auto there = [](const fs::path& path) {
    std::error_code ignored;
    return fs::exists(path, ignored);
  };
  const fs::path base(folder);
  if (wants("bag") && !there(base / "scene.bag")) return false;
  for (const Sensor& sensor : request.sensors) {
    if (wants("pcd") && !there(base / (sensor.name + ".pcd"))) return false;
    if (wants("png") && !there(base / (sensor.name + ".png"))) return false;
  }
  return !wants("bop") || there(root(accepted) / "bop" / "train" / six_digits(index) / "scene_gt.json");
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
    std::ifstream file(fs::path(path) / "scene.json");
    if (!file) continue;
    const nlohmann::json json = nlohmann::json::parse(file, nullptr, false);
    if (!json.is_object()) {
      throw input_error("scene.json is there already, but it is cut off or damaged", path,
                        "remove this folder, and the scene is made anew");
    }
    if (json.value("request_sha256", nlohmann::json()) != request.text_sha256) {
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

void SceneStore::write(const Generator::Result& result, const Request& request, const Generator& generator) {
  const Scene& scene = result.scene;
  const bool accepted = scene.report.accepted;
  const std::string target = folder(scene.index, accepted);
  const fs::path root = fs::path(target).parent_path();
  make_directory(root);

  if (wants("bop")) {
    make_directory(root / "bop" / "train");
    if (models_written_.insert(accepted).second) write_bop_models((root / "bop").string(), generator.parts());
    write_whole((root / "bop" / "train" / six_digits(scene.index)).string(),
                [&](const std::string& hidden) { write_bop(hidden, scene, generator.parts(), result.images); });
  }

  write_whole(target, [&](const std::string& hidden) {
    make_directory(hidden);
    const fs::path base(hidden);
    for (const RangeImage& image : result.images) {
      if (wants("pcd")) write_pcd((base / (image.sensor.name + ".pcd")).string(), image);
      if (wants("png")) write_pngs(hidden, image);
    }
    if (wants("bag")) {
      bag_writer()((base / "scene.bag").string(), scene, request, result.images, generator.parts(),
                   generator.bin_model());
    }
    write_text((base / "scene.json").string(), scene_json(scene, request));
  });

  // With --overwrite the scene may have been on the other side before.
  std::error_code ignored;
  fs::remove_all(folder(scene.index, !accepted), ignored);
}

}  // namespace bin_scenes
