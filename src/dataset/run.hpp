/// Makes a data set, or completes one that is unfinished: finished scenes are kept, and missing ones are made. This is
/// the command `bin_scenes dataset` without its options.
#pragma once

#include "dataset/data_folder.hpp"

#include <atomic>
#include <functional>
#include <string>

namespace bin_scenes {

struct RunProgress {
  /// Number of heaps of the share of this run, and of those that are done, including earlier runs.
  std::size_t heaps = 0, heaps_done = 0;
  std::size_t accepted = 0, rejected = 0, failed = 0;  ///< scenes that are there; attempts set apart; heaps given up
  std::size_t not_poured = 0, asked_for = 0;           ///< parts of the heaps that are there; known at the end
  double scenes_per_hour = 0.0;                        ///< rate of this run
  double remaining_s = 0.0;
  std::string phase;  ///< "scenes", "pack"
};

struct RunOptions {
  std::size_t workers = 0;            ///< 0: as many as cores
  std::size_t shard = 0, shards = 1;  ///< makes heaps whose number leaves `shard` when divided by `shards`
  std::function<void(const RunProgress&)> progress;
  std::function<void(const std::string&)> warn;
  const std::atomic<bool>* stop = nullptr;  ///< when set, the run ends with Error(cancelled)
};

/// Only a whole data set is packed into shards; of one that is made in shares, merge_datasets() does it. The process
/// must have no threads. Throws Error.
RunProgress run_dataset(const Plan& plan, const std::string& directory, const RunOptions& options);

/// Bytes that one scene of the plan takes on the disk, about: set by what finished scenes of up to 300 parts took.
double estimate_scene_bytes(const Plan& plan);

}  // namespace bin_scenes
