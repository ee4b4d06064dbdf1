/// index.sqlite: the outcome of each heap and scene, and the time that it took. Except for the times, the index can be
/// rebuilt from the scenes, so that losing it loses no data.
#pragma once

#include "dataset/record.hpp"

#include <filesystem>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

struct sqlite3;

namespace bin_scenes {

struct IndexCounts {
  std::size_t failed = 0;                     ///< heaps whose attempts were all rejected
  std::size_t scenes = 0, rejected = 0;       ///< finished scenes; attempts that were set apart
  std::size_t not_poured = 0, asked_for = 0;  ///< parts in the first scene of each heap
  double wall_s = 0.0;    ///< wall-clock time of the workers (s), over all heaps whose time is known
  double cpu_s = 0.0;     ///< processor time of the workers (s), over the same heaps
  std::size_t timed = 0;  ///< heaps whose time is known
};

class SceneIndex {
 public:
  /// Opens or creates the index. Throws an environment Error; throws an input Error if the file is damaged.
  explicit SceneIndex(const std::filesystem::path& path, bool only_read = false);
  ~SceneIndex();
  SceneIndex(const SceneIndex&) = delete;
  SceneIndex& operator=(const SceneIndex&) = delete;

  /// Stores a record in one transaction, and replaces an earlier one of the same heap.
  void put(const HeapRecord& record);
  void forget(std::size_t heap);
  std::set<std::size_t> heaps() const;  ///< heaps that are finished or have failed
  IndexCounts counts() const;
  /// Adds a share to those that this folder must contain: the heaps whose number modulo `shards` is `shard`.
  void add_share(std::size_t shard, std::size_t shards);
  std::set<std::pair<std::size_t, std::size_t>> shares() const;
  std::map<std::string, double> stages_ms() const;  ///< wall-clock time by stage (ms), summed over all heaps

  struct Row {
    std::size_t scene, heap;
    std::string path, sha256;
    double wall_s;  ///< wall-clock time of its heap (s)
    nlohmann::json summary;
  };
  void each_scene(const std::function<void(const Row&)>& visit) const;  ///< in the order of scenes
  struct Rejected {
    std::size_t heap, attempt;
    std::string path, reasons;
  };
  std::vector<Rejected> rejected() const;  ///< in the order of heaps
  HeapRecord record(std::size_t heap) const;

  /// Returns the result rows of a statement as text.
  std::vector<std::vector<std::string>> rows(const std::string& sql, const std::vector<std::string>& values = {}) const;

 private:
  std::string path_;
  sqlite3* database_ = nullptr;
};

}  // namespace bin_scenes
