/// The directory of a job: one folder for each scene, which gets its final name only when it is complete.
///
///     DIR/scene_000007/            scene.json, <sensor>.pcd, <sensor>.ply, <sensor>*.png, scene.bag,
///                                  scene.mcap, grasps.json
///     DIR/bop/train/000007/        the scene in BOP's layout; DIR/bop/models/ its models
///     DIR/set_apart/...            the same for scenes that were not accepted
///     each of these folders: files.json, the size and SHA-256 of every other file in it
///
/// A job can be resumed: a scene is not made again if its scene.json contains the hash of the request, and if all of
/// its files have the sizes that files.json states.
#pragma once

#include "bin_scenes/config/formats.hpp"
#include "bin_scenes/generate/generator.hpp"

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

namespace bin_scenes {

class WholeFolders;

class SceneStore {
 public:
  /// Checks the formats, and that `directory` can be written. Removes what killed runs left incomplete. Makes no scene
  /// yet.
  /// @param mcap    version of the ROS messages in MCAP files
  /// @param verify  whether an existing scene counts only if its files also have the stated digests
  SceneStore(const std::string& directory, const std::vector<std::string>& formats,
             McapProfile mcap = McapProfile::ros1, bool verify = false);

  bool needs_sensors() const;  ///< whether some format contains only data of sensors
  bool needs_grasps() const;
  bool needs_gray() const;
  bool needs_images() const;  ///< whether some format contains images of sensors

  /// Returns the indices of the request's scenes that have a folder. It reads the directory, because the request may
  /// ask for far more scenes.
  std::set<std::size_t> indices(const Request& request) const;
  enum class Found { nothing, accepted, set_apart };
  /// Returns which files of scene `index` exist.
  Found find(std::size_t index, const Request& request) const;
  /// Returns the reasons of an existing scene that was set apart.
  std::vector<std::string> reasons(std::size_t index) const;

  /// Writes all folders of the scene under hidden names, then frees the images of `result`. May be called in any
  /// thread, for several scenes at the same time.
  void prepare(Generator::Result& result, const Generator& generator);
  /// Renames the folders of a scene to their final names: all of them or none. An older scene of this index is removed
  /// if it is on the other side (accepted or set apart).
  void commit(const Generator::Result& result, const Request& request, const Generator& generator);

 private:
  bool wants(const std::string& format) const { return formats_.count(format) != 0; }
  bool needs(SceneFormat::Needs what) const;
  std::filesystem::path root(bool accepted) const;
  std::string folder(std::size_t index, bool accepted) const;
  std::filesystem::path bop_folder(std::size_t index, bool accepted) const;
  bool complete(const std::string& folder, std::size_t index, const Request& request, bool accepted) const;

  std::string directory_;
  std::set<std::string> formats_;
  McapProfile mcap_;
  bool verify_;
  std::mutex mutex_;
  std::map<std::size_t, std::shared_ptr<WholeFolders>> prepared_;  ///< by index of the scene; under mutex_
  std::set<bool> models_written_;  ///< whether BOP models were written: accepted, set apart
};

}  // namespace bin_scenes
