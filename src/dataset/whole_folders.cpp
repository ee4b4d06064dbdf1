/// Checks formats, writes the files of a scene, and keeps folders hidden until they are whole, each with the list of
/// its files.
#include "dataset/whole_folders.hpp"

#include "bin_scenes/core/error.hpp"
#include "bin_scenes/output/output_format.hpp"
#include "bin_scenes/output/scene_writer.hpp"
#include "core/read_file.hpp"

#include <nlohmann/json.hpp>

#include <unistd.h>

#include <algorithm>
#include <fstream>

namespace bin_scenes {

namespace fs = std::filesystem;

namespace {
constexpr const char* manifest = "files.json";
}  // namespace

void check_formats(const std::set<std::string>& formats, const std::string& where) {
  for (const std::string& format : formats)
    if (!find_scene_format(format)) throw input_error("unknown format '" + format + "'", where, format_names("or"));
  for (const OutputFormat& format : output_formats()) {
    if (formats.count(format.name) == 0 || !format.available || format.available()) continue;
    throw environment_error("this build has no ROS, whose messages '" + format.name + "' holds", where,
                            "build with -DBIN_SCENES_ROS=ON, or ask for json, pcd, ply, png or bop");
  }
}

void check_writable(const fs::path& directory) {
  fs::path place = fs::absolute(directory).lexically_normal();
  std::error_code error;
  while (!fs::exists(place, error) && place.has_relative_path()) place = place.parent_path();
  if (!fs::is_directory(place, error)) {
    throw input_error("'" + place.string() + "' is not a directory", directory.string(), "name a directory for --out");
  }
  if (::access(place.c_str(), W_OK | X_OK) != 0) {
    throw environment_error("'" + place.string() + "' cannot be written", directory.string(),
                            "check permissions, or name another directory for --out");
  }
}

std::optional<SceneFile> scene_in(const fs::path& folder) {
  try {
    return read_scene_file((folder / "scene.json").string());
  } catch (const Error&) {
    return std::nullopt;
  }
}

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

bool has_manifest(const std::string& folder) {
  return fs::exists(fs::path(folder) / manifest);
}

void write_scene_files(const std::string& folder, const std::set<std::string>& formats, const Generator::Result& result,
                       const LoadedRequest& loaded, McapProfile mcap) {
  const SceneOutput output{result.scene, loaded, result.images, result.grasps ? &*result.grasps : nullptr, mcap};
  for (const OutputFormat& format : output_formats())
    if (formats.count(format.name) && format.write) format.write(folder, output);
  write_text((fs::path(folder) / "scene.json").string(), scene_json(result.scene, loaded, result.images));
}

WholeFolders::~WholeFolders() {
  folders_.clear();
  for (auto made = made_.rbegin(); made != made_.rend(); ++made) {
    std::error_code not_empty;
    fs::remove(*made, not_empty);
  }
}

void WholeFolders::write(const fs::path& target, const std::function<void(const std::string&)>& fill) {
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

void WholeFolders::commit() {
  for (const auto& folder : folders_) folder->commit();
  folders_.clear();
  made_.clear();
}

void WholeFolders::make_parents(const fs::path& target) {
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

}  // namespace bin_scenes
