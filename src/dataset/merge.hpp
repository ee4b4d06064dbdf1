/// Joins data sets that were made in shares, on one or several machines, into one data set. The result has the same
/// bytes as a data set that was made in one piece, except for the index.
#pragma once

#include <atomic>
#include <string>
#include <vector>

namespace bin_scenes {

struct Merged {
  std::size_t scenes = 0, rejected = 0, missing = 0;  ///< missing: heaps that no share has
};

/// Joins folders of one plan into `out`, which becomes the same, byte for byte, as the data set of one run. Files are
/// linked if the file system allows it, and copied otherwise. What exists already is kept: a run that was killed at any
/// time continues when it is repeated. Throws an input Error for folders of different plans or versions.
Merged merge_datasets(const std::vector<std::string>& shares, const std::string& out, const std::atomic<bool>* stop);

}  // namespace bin_scenes
