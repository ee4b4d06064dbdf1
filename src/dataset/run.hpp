/// Makes a data set, or completes one that is unfinished: finished scenes are kept, and missing ones are made. This is
/// the command `bin_scenes dataset` without its options.
#pragma once

#include "dataset/data_folder.hpp"

#include <atomic>
#include <functional>
#include <string>

namespace bin_scenes {

struct RunProgress {
  /// Number of heaps in the share of this run, and the number of finished ones, including those of earlier runs.
  std::size_t heaps = 0, heaps_done = 0;
  std::size_t accepted = 0, rejected = 0, failed = 0;  ///< scenes; attempts set apart; heaps without scenes
  std::size_t not_poured = 0, asked_for = 0;           ///< parts of the finished heaps; known at the end
  double scenes_per_hour = 0.0;                        ///< rate of this run
  double remaining_s = 0.0;                            ///< estimated time until the end of the run (s)
  std::string phase;                                   ///< "scenes" or "pack"
};

struct RunOptions {
  std::size_t workers = 0;            ///< number of worker processes; 0: one per core
  std::size_t shard = 0, shards = 1;  ///< makes the heaps whose number modulo `shards` is `shard`
  std::function<void(const RunProgress&)> progress;
  std::function<void(const std::string&)> warn;
  const std::atomic<bool>* stop = nullptr;  ///< if it becomes true, the run ends with Error(cancelled)
};

/// Makes or completes a data set. Only a complete data set is packed into shards; if it is made in shares,
/// merge_datasets() packs them. The process must have no other threads. Throws Error.
RunProgress run_dataset(const Plan& plan, const std::string& directory, const RunOptions& options);

/// Returns the estimated size of one scene on the disk (bytes), from measured sizes of scenes of up to 300 parts.
double estimate_scene_bytes(const Plan& plan);

}  // namespace bin_scenes
