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

/// Throws an Error for formats that are unknown or that this build lacks. `where`: name of the option, for the message.
void check_formats(const std::set<std::string>& formats, const std::string& where);
/// Checks that files can be made in the directory, or in its nearest existing parent; to be called before simulating.
void check_writable(const std::filesystem::path& directory);

/// Reads scene.json of a folder; empty if it is missing or damaged.
std::optional<SceneFile> scene_in(const std::filesystem::path& folder);

/// Writes files.json: the sizes and digests of all other files of the folder.
void write_manifest(const std::string& folder);
bool has_manifest(const std::string& folder);
/// Returns whether the folder has all files of its files.json with their sizes and, if `digests`, their digests. A
/// folder without files.json comes from a run that was killed, or from an earlier version.
bool whole(const std::filesystem::path& folder, bool digests);

/// Writes scene.json and the files of all `formats` (output/output_format.hpp), except for the folder of BOP.
void write_scene_files(const std::string& folder, const std::set<std::string>& formats, const Generator::Result& result,
                       const LoadedRequest& loaded, McapProfile mcap = McapProfile::ros1);

/// Folders that are written under hidden names. commit() renames them when all of them are complete. Without commit(),
/// they are removed, with the parent directories that were made for them.
class WholeFolders {
 public:
  WholeFolders() = default;
  WholeFolders(const WholeFolders&) = delete;
  WholeFolders& operator=(const WholeFolders&) = delete;
  ~WholeFolders();

  /// Calls `fill` with the hidden folder that becomes `target`. Errors of `fill` name `target` instead of that folder.
  void write(const std::filesystem::path& target, const std::function<void(const std::string& hidden)>& fill);
  /// Renames the folders to their final names, in the order in which they were written.
  void commit();

 private:
  void make_parents(const std::filesystem::path& target);

  std::vector<std::unique_ptr<Temporary>> folders_;
  std::vector<std::filesystem::path> made_;  ///< parent directories that were made, outermost first
};

}  // namespace bin_scenes
