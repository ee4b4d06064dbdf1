/// Packs images into shards: tar files in BOP's layout by images with at most a thousand images each, as WebDataset
/// reads them.
#pragma once

#include "dataset/data_folder.hpp"

#include <nlohmann/json.hpp>

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace bin_scenes {

/// Returns how many scenes a shard covers. The number is fixed, so that a shard does not depend on other shards. Where
/// heaps have failed, a shard has fewer images.
std::size_t scenes_per_shard(const DataSetFacts& facts);
std::size_t shard_of(const DataSetFacts& facts, std::size_t scene);
std::size_t shard_count(const DataSetFacts& facts);

/// Returns the offset index that is stored next to a shard. Throws an input Error if it is missing or damaged.
nlohmann::ordered_json offsets_of(const DataFolder& folder, std::size_t shard);

/// Packs samples into shards and removes the samples. Beside each shard is an offset index (shard-000000.json: key ->
/// file -> [offset, bytes]), and key_to_shard.json states in which shard each image is. Shards that were packed before
/// are kept: a run that was killed at any time continues from there. Throws Error.
class ShardPacker {
 public:
  /// @param done  heaps that are finished or have failed
  ShardPacker(const DataFolder& folder, const DataSetFacts& facts, std::set<std::size_t> done);
  /// States that a heap is finished. Packs each shard that is complete with it, so that it can be read already.
  void add(std::size_t heap);
  void pack_all();

 private:
  bool all_done(std::size_t shard) const;
  void pack(std::size_t shard);
  void note(std::size_t shard);
  void write_map() const;

  DataFolder folder_;
  DataSetFacts facts_;
  std::set<std::size_t> done_;
  nlohmann::json shard_of_key_ = nlohmann::json::object();
};

/// Turns the last shard back into samples if it has room for more scenes, as a data set that grows needs it.
void unpack_last_shard(const DataFolder& folder, const DataSetFacts& facts);

/// Writes a tar file whose bytes depend only on names and contents. Returns offset and size of each file's contents.
std::vector<std::pair<std::size_t, std::size_t>> write_tar(
    const std::string& path, const std::vector<std::pair<std::string, std::filesystem::path>>& files);

using ShardImages = std::map<std::string, std::map<std::string, std::string>>;  ///< key -> file -> contents
/// Reads all files of a shard; empty if it is truncated or not a tar file. `doubled`: whether a file occurs twice.
std::optional<ShardImages> read_tar(const std::string& path, bool& doubled);

}  // namespace bin_scenes
