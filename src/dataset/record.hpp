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
  bool accepted = false;   ///< else every attempt was rejected
  double wall_s = 0.0;     ///< negative: not known, since it was found on the disk
  double cpu_s = 0.0;      ///< processor time of all threads of the worker (s)
  double memory_mb = 0.0;  ///< resident memory of the worker after the heap
  std::map<std::string, double> stages_ms;
  std::vector<SceneRecord> scenes;
  std::vector<RejectedRecord> rejected;
};

/// Whether nothing is left that could be taken out: such a scene is the last of its heap.
bool is_empty(const SceneFile& scene);

nlohmann::json json_of(const HeapRecord& record);
HeapRecord record_of(const nlohmann::json& json);

/// Histograms and figures of a scene for the report.
nlohmann::json summary_of(const SceneFile& scene);

}  // namespace bin_scenes
