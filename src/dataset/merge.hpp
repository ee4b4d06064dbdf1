/// Joins data sets that were made in shares, on one or several machines, into one data set. The result has the same
/// bytes as a data set that was made in one piece, except for the index.
#pragma once

#include <atomic>
#include <string>
#include <vector>

namespace bin_scenes {

struct Merged {
  std::size_t scenes = 0, rejected = 0, missing = 0;  ///< missing: number of heaps that no share contains
};

/// Joins the shares of one plan into `out`, which equals the data set of one run byte for byte. Files are linked if the
/// file system allows it, and copied otherwise. Existing files are kept, so that a run that was killed continues when
/// it is repeated. Throws an input Error for folders of different plans or versions.
Merged merge_datasets(const std::vector<std::string>& shares, const std::string& out, const std::atomic<bool>* stop);

}  // namespace bin_scenes
