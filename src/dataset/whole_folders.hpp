/// Folders of scene files that appear either complete or not at all. A list of digests in each folder allows a later
/// check that its files are unchanged.
#pragma once

#include "bin_scenes/config/formats.hpp"
#include "bin_scenes/config/scene_file.hpp"
#include "bin_scenes/core/temporary.hpp"
#include "bin_scenes/generate/generator.hpp"

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace bin_scenes {

/// Throws Error for formats that are unknown, or that this build lacks. `where`: the option that names them.
void check_formats(const std::set<std::string>& formats, const std::string& where);
/// Before hours of simulation, not after them: the nearest directory that exists has to take new files.
void check_writable(const std::filesystem::path& directory);

/// scene.json of a folder; none if it is missing or damaged.
std::optional<SceneFile> scene_in(const std::filesystem::path& folder);

/// Writes down what is in a folder in files.json, itself left out: sizes and digests.
void write_manifest(const std::string& folder);
bool has_manifest(const std::string& folder);
/// Whether everything that was written into a folder is there: each file with its size, and with its digest on request.
/// A folder without the list of its files is of a run that was killed, or of an earlier version.
bool whole(const std::filesystem::path& folder, bool digests);

/// scene.json, and the files of the formats that are named (output/output_format.hpp), but for BOP's folder.
void write_scene_files(const std::string& folder, const std::set<std::string>& formats, const Generator::Result& result,
                       const LoadedRequest& loaded, McapProfile mcap = McapProfile::ros1);

/// Folders that are written under hidden names and take their own only when all of them are whole. Without commit()
/// nothing of them is left, nor of the directories above them that were made for them.
class WholeFolders {
 public:
  WholeFolders() = default;
  WholeFolders(const WholeFolders&) = delete;
  WholeFolders& operator=(const WholeFolders&) = delete;
  ~WholeFolders();

  /// `fill` writes into the folder it is given. Its errors name the folder that it was to become.
  void write(const std::filesystem::path& target, const std::function<void(const std::string& hidden)>& fill);
  /// Renames the folders to their final names, in the order in which they were written.
  void commit();

 private:
  void make_parents(const std::filesystem::path& target);

  std::vector<std::unique_ptr<Temporary>> folders_;
  std::vector<std::filesystem::path> made_;  ///< outermost first
};

}  // namespace bin_scenes
