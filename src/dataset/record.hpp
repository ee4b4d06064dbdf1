/// The record of one heap: what a worker process reports to its parent. The index stores it (scene_index.hpp).
#pragma once

#include "bin_scenes/config/scene_file.hpp"

#include <nlohmann/json.hpp>

#include <map>
#include <string>
#include <vector>

namespace bin_scenes {

struct SceneRecord {
  std::size_t scene = 0;
  std::string path;        ///< path within the data set
  std::string sha256;      ///< digest of its files.json, which contains the digests of all its files
  nlohmann::json summary;  ///< the values that the report shows; see summary_of()
};

struct RejectedRecord {
  std::size_t attempt = 0;
  std::string path;
  std::vector<std::string> reasons;
};

struct HeapRecord {
  std::size_t heap = 0;
  bool accepted = false;   ///< false: every attempt was rejected
  double wall_s = 0.0;     ///< wall-clock time (s); negative: not known, because the heap was found on the disk
  double cpu_s = 0.0;      ///< processor time of all threads of the worker (s)
  double memory_mb = 0.0;  ///< resident memory of the worker after the heap (MB)
  std::map<std::string, double> stages_ms;  ///< wall-clock time of each stage (ms)
  std::vector<SceneRecord> scenes;
  std::vector<RejectedRecord> rejected;
};

/// Returns whether no part is left that could be removed: such a scene is the last one of its heap.
bool is_empty(const SceneFile& scene);

nlohmann::json json_of(const HeapRecord& record);
HeapRecord record_of(const nlohmann::json& json);

/// Returns the histograms and values of a scene that the report shows.
nlohmann::json summary_of(const SceneFile& scene);

}  // namespace bin_scenes
