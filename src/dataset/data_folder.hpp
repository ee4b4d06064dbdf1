/// The directory of a data set: the names of its files, and the lock that keeps out other processes.
///
///     DIR/dataset.json                     plan, version and size, written before anything else
///     DIR/plan.yaml                        the plan as it was read
///     DIR/scenes/scene_000007/             scene.json, request.yaml, files.json, images
///     DIR/set_apart/scene_000007_attempt_0/  the same for attempts that were not accepted
///     DIR/bop/train/000007/, bop/models/   BOP's layout by scenes; `train`, or the splits of the plan
///     DIR/bop/*.json                       cameras, targets and description of all scenes together
///     DIR/samples/000007/                  BOP's layout by images, until these are packed into shards
///     DIR/shards/shard-000000.tar, ...
///     DIR/index.sqlite                     state, times, digests; only the times are stored nowhere else
///
/// Except for index.sqlite, all files are the same byte for byte, however the data set was made (shares, restarts).
#pragma once

#include "bin_scenes/config/plan.hpp"
#include "bop/root.hpp"

#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace bin_scenes {

/// What dataset.json states.
struct DataSetFacts {
  std::string plan_sha256;       ///< digest of everything that determines the scenes
  std::string plan_text_sha256;  ///< digest of the text of plan.yaml
  std::string version;
  std::size_t heaps = 0, steps = 0, attempts = 0, sensors = 0;
  std::vector<std::string> formats;
  double tolerance = 0.0;  ///< depth tolerance (m) of visible pixels; 0: the true image decides which are visible
  BopLayout bop;
  bool run_lengths = false;      ///< BOP: masks are run lengths in JSON files instead of PNG files
  std::size_t most_targets = 0;  ///< BOP: images with more visible parts are no targets; 0: no limit
  std::size_t shard_size = 0;
  std::vector<std::pair<std::string, double>> split;  ///< name and share of each split; never empty

  std::size_t scenes() const { return heaps * (steps + 1); }
  bool wants(const std::string& format) const;
  /// Returns the split of a heap. It depends only on the number of the heap: a data set that grows keeps its splits,
  /// and any range of heaps is divided approximately according to the shares.
  std::string split_of(std::size_t heap) const;
  std::string split_of_scene(std::size_t scene) const { return split_of(scene / (steps + 1)); }
  bool operator==(const DataSetFacts& other) const;
};
struct DataFolder {
  std::filesystem::path root;

  std::filesystem::path index() const { return root / "index.sqlite"; }
  std::filesystem::path scene(std::size_t scene) const;
  std::filesystem::path set_apart(std::size_t scene, std::size_t attempt) const;
  std::filesystem::path bop(const DataSetFacts& facts, std::size_t scene) const;
  std::filesystem::path samples(std::size_t scene) const;
  std::filesystem::path shards() const { return root / "shards"; }
  std::filesystem::path shard(std::size_t shard) const;
};

/// Returns the state of the folder `bop`: its layout, and what has been written to it so far.
BopFolder bop_folder(const DataFolder& folder, const DataSetFacts& facts);

DataSetFacts facts_of(const Plan& plan);
/// Reads dataset.json. Throws an input Error if the folder is not a data set.
DataSetFacts read_facts(const std::filesystem::path& root);

/// Makes the folder with dataset.json and plan.yaml, or checks that an existing one has the same plan and version, and
/// throws an input Error otherwise. Two plans that differ only in the number of heaps are the same plan. Returns the
/// facts of the existing folder, which put_plan() replaces.
DataSetFacts claim(const DataFolder& folder, const DataSetFacts& facts, const std::string& plan_text);
void put_plan(const DataFolder& folder, const DataSetFacts& facts, const std::string& plan_text);

/// Locks a folder, so that only one process at a time works in it. The end of the process releases the lock.
class FolderLock {
 public:
  explicit FolderLock(const std::filesystem::path& root);  ///< throws an environment Error if another process has it
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_;
};

/// Returns whether another process holds the lock of the folder.
bool is_worked_in(const std::filesystem::path& root);

/// Returns the heaps that have a folder, complete or not. It reads the directory, however many heaps the plan has.
std::set<std::size_t> heaps_in(const DataFolder& folder, const DataSetFacts& facts);

/// Returns all folders in which files and folders of the data set are renamed to their final names.
std::vector<std::filesystem::path> folders_of(const DataFolder& folder);
/// Removes the incomplete files that killed processes left.
void remove_leftovers(const DataFolder& folder);

}  // namespace bin_scenes
