#include "tool/scene_store.hpp"

#include "bin_scenes/core/error.hpp"
#include "bin_scenes/core/temporary.hpp"
#include "bin_scenes/output/scene_writer.hpp"
#include "core/read_file.hpp"

#include <nlohmann/json.hpp>

#include <unistd.h>

#include <charconv>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>

namespace bin_scenes {

namespace fs = std::filesystem;

namespace {

constexpr const char* manifest = "files.json";

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

/// scene.json of a folder, no object if it is damaged; none if there is none.
std::optional<nlohmann::json> scene_in(const std::string& folder) {
  std::ifstream file(fs::path(folder) / "scene.json");
  if (!file) return std::nullopt;
  return nlohmann::json::parse(file, nullptr, false);
}

/// Writes down what is in a folder, itself left out.
void write_manifest(const std::string& folder) {
  nlohmann::ordered_json files = nlohmann::ordered_json::object();
  std::set<fs::path> paths;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) paths.insert(entry.path());
  }
  for (const fs::path& path : paths) {
    files[path.lexically_relative(folder).string()] = {{"bytes", fs::file_size(path)},
                                                       {"sha256", sha256_of_file(path.string())}};
  }
  write_text((fs::path(folder) / manifest).string(),
             nlohmann::ordered_json{{"format", "bin_scenes/files/1"}, {"files", files}}.dump(1) + "\n");
}

/// Whether everything that was written into a folder is there: each file with its size, and with its digest on request.
/// A folder without the list of its files is of a run that was killed, or of an earlier version.
bool whole(const fs::path& folder, bool digests) {
  std::ifstream file(folder / manifest);
  const nlohmann::json list = nlohmann::json::parse(file, nullptr, false);
  if (!list.is_object() || !list.contains("files") || !list["files"].is_object()) return false;
  for (const auto& [name, entry] : list["files"].items()) {
    std::error_code gone;
    const fs::path path = folder / name;
    const std::uintmax_t size = fs::file_size(path, gone);
    if (gone || !entry.is_object() || entry.value("bytes", std::uintmax_t{0}) != size) return false;
    if (digests && entry.value("sha256", "") != sha256_of_file(path.string())) return false;
  }
  return true;
}

bool is_of(const Request& request, const nlohmann::json& scene) {
  return scene.is_object() && scene.value("request_sha256", nlohmann::json()) == request.text_sha256;
}

/// Folders that are written under hidden names and take their own only when all of them are whole. Without commit()
/// nothing of them is left, nor of the directories above them that were made for them.
class WholeFolders {
 public:
  WholeFolders() = default;
  WholeFolders(const WholeFolders&) = delete;
  WholeFolders& operator=(const WholeFolders&) = delete;
  ~WholeFolders() {
    folders_.clear();
    for (auto made = made_.rbegin(); made != made_.rend(); ++made) {
      std::error_code not_empty;
      fs::remove(*made, not_empty);
    }
  }

  /// `fill` writes into the folder it is given. Its errors name the folder that it was to become.
  template <typename Fill>
  void write(const fs::path& target, const Fill& fill) {
    make_parents(target);
    folders_.push_back(std::make_unique<Temporary>(target.string()));
    const std::string& hidden = folders_.back()->path();
    try {
      make_directory(hidden);
      fill(hidden);
      write_manifest(hidden);
    } catch (const Error& error) {
      std::string where = error.where();
      if (where.rfind(hidden, 0) == 0) where.replace(0, hidden.size(), target.string());
      throw Error(error.kind(), error.problem(), where, error.remedy());
    }
  }

  /// In the order in which they were written.
  void commit() {
    for (const auto& folder : folders_) folder->commit();
    made_.clear();
  }

 private:
  void make_parents(const fs::path& target) {
    std::vector<fs::path> missing;
    std::error_code ignored;
    for (fs::path place = target.parent_path(); !place.empty() && !fs::exists(place, ignored);
         place = place.parent_path()) {
      missing.push_back(place);
    }
    for (auto place = missing.rbegin(); place != missing.rend(); ++place) {
      make_directory(*place);
      made_.push_back(*place);
    }
  }

  std::vector<std::unique_ptr<Temporary>> folders_;
  std::vector<fs::path> made_;  ///< outermost first
};

}  // namespace

SceneStore::SceneStore(const std::string& directory, const std::vector<std::string>& formats, bool verify)
    : directory_(directory), formats_(formats.begin(), formats.end()), verify_(verify) {
  check_formats(formats_);
  check_writable(directory);
  for (const bool accepted : {true, false}) {
    for (const char* below : {"", "bop", "bop/train"}) remove_leftovers((root(accepted) / below).string());
  }
}

bool SceneStore::needs_sensors() const {
  return wants("pcd") || wants("png") || wants("bop");
}
bool SceneStore::needs_images() const {
  return needs_sensors() || wants("bag");
}
bool SceneStore::needs_silhouettes() const {
  return wants("bop");
}

fs::path SceneStore::root(bool accepted) const {
  return accepted ? fs::path(directory_) : fs::path(directory_) / "set_apart";
}

std::string SceneStore::folder(std::size_t index, bool accepted) const {
  return (root(accepted) / ("scene_" + six_digits(index))).string();
}

fs::path SceneStore::bop_folder(std::size_t index, bool accepted) const {
  return root(accepted) / "bop" / "train" / six_digits(index);
}

bool SceneStore::complete(const std::string& folder, std::size_t index, const Request& request, bool accepted) const {
  const auto there = [](const fs::path& path) {
    std::error_code ignored;
    return fs::exists(path, ignored);
  };
  const fs::path base(folder);
  if (!whole(base, verify_)) return false;
  if (wants("bag") && !there(base / "scene.bag")) return false;
  for (const Sensor& sensor : request.sensors) {
    if (wants("pcd") && !there(base / (sensor.name + ".pcd"))) return false;
    if (wants("png") && !there(base / (sensor.name + ".png"))) return false;
  }
  const fs::path bop = bop_folder(index, accepted);
  return !wants("bop") || (there(bop / "scene_gt.json") && whole(bop, verify_));
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
    const std::optional<nlohmann::json> json = scene_in(path);
    if (!json) continue;
    if (!json->is_object() && fs::exists(fs::path(path) / manifest)) continue;  // ours, and damaged since
    if (!json->is_object()) {
      throw input_error("scene.json is there already, but it is cut off or damaged", path,
                        "remove this folder, and the scene is made anew");
    }
    if (!is_of(request, *json)) {
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
  WholeFolders folders;
  folders.write(folder(scene.index, accepted), [&](const std::string& hidden) {
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
  if (wants("bop")) {
    if (models_written_.count(accepted) == 0) {
      folders.write(root(accepted) / "bop" / "models",
                    [&](const std::string& hidden) { write_bop_models(hidden, generator.parts()); });
    }
    folders.write(bop_folder(scene.index, accepted),
                  [&](const std::string& hidden) { write_bop(hidden, scene, generator.parts(), result.images); });
  }

  // What an earlier scene of this index left behind, on either side, shows another scene.
  std::error_code ignored;
  const std::optional<nlohmann::json> earlier = scene_in(folder(scene.index, accepted));
  const bool same = earlier && is_of(request, *earlier);
  folders.commit();
  if (wants("bop")) models_written_.insert(accepted);
  if (!wants("bop") && !same) fs::remove_all(bop_folder(scene.index, accepted), ignored);
  fs::remove_all(folder(scene.index, !accepted), ignored);
  fs::remove_all(bop_folder(scene.index, !accepted), ignored);
}

}  // namespace bin_scenes
