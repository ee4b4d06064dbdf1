/// The directory of a data set, and whose it is.
///
///     DIR/dataset.json                     plan, version and size, written before anything else
///     DIR/plan.yaml                        the plan as it was read
///     DIR/scenes/scene_000007/             scene.json, request.yaml, files.json, images
///     DIR/set_apart/scene_000007_attempt_0/  the same for what was not accepted
///     DIR/bop/train/000007/, bop/models/   BOP's layout by scenes; `train`, or what the plan splits into
///     DIR/bop/*.json                       cameras, targets and description of all scenes together
///     DIR/samples/000007/                  BOP's layout by images, until it is packed into
///     DIR/shards/shard-000000.tar, ...
///     DIR/index.sqlite                     state, times, digests: nothing that a scene does not state itself but times
///
/// Everything but index.sqlite is the same, byte for byte, however it was made.
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
  double tolerance = 0.0;  ///< m, of visible pixels by measured depth; 0: they are those of the true image
  BopLayout bop;
  bool run_lengths = false;      ///< bop: masks are run lengths in JSON files instead of PNG files
  std::size_t most_targets = 0;  ///< bop: visible parts of an image that is a target; 0: any number
  std::size_t shard_size = 0;
  std::vector<std::pair<std::string, double>> split;  ///< never empty

  std::size_t scenes() const { return heaps * (steps + 1); }
  bool wants(const std::string& format) const;
  /// Fixed for a heap, however many there are: a data set that grows keeps its splits, and any part of it has them in
  /// about their shares.
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

/// Its folder in BOP's layout, as far as it is made.
BopFolder bop_folder(const DataFolder& folder, const DataSetFacts& facts);

DataSetFacts facts_of(const Plan& plan);
/// Throws an input Error if DIR is no data set.
DataSetFacts read_facts(const std::filesystem::path& root);

/// Makes the folder with dataset.json and plan.yaml, or checks that it is of the same plan and version. Throws an input
/// Error with advice for a folder of another plan or version, or of something else. A plan of more heaps is the same
/// plan: the facts that are there say so, and put_plan() makes them new.
DataSetFacts claim(const DataFolder& folder, const DataSetFacts& facts, const std::string& plan_text);
void put_plan(const DataFolder& folder, const DataSetFacts& facts, const std::string& plan_text);

/// Only one process at a time works in a folder. The lock is released when the process ends, in whatever way.
class FolderLock {
 public:
  explicit FolderLock(const std::filesystem::path& root);  ///< throws an environment Error if another one has it
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_;
};

/// Whether another process has that lock.
bool is_worked_in(const std::filesystem::path& root);

/// Heaps of which there is a folder, whole or not: what a start has to look through, however many a plan asks for.
std::set<std::size_t> heaps_in(const DataFolder& folder, const DataSetFacts& facts);

/// Where files and folders of the data set appear under their names.
std::vector<std::filesystem::path> folders_of(const DataFolder& folder);
/// Removes what killed processes left half-written.
void remove_leftovers(const DataFolder& folder);

}  // namespace bin_scenes
