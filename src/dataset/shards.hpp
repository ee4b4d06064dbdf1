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

/// Scenes of a shard: a fixed range, so that a shard does not depend on what others hold. Where heaps have failed, it
/// has fewer images.
std::size_t scenes_per_shard(const DataSetFacts& facts);
std::size_t shard_of(const DataSetFacts& facts, std::size_t scene);
std::size_t shard_count(const DataSetFacts& facts);

/// The offset index beside a shard. Throws an input Error if it is missing or damaged.
nlohmann::ordered_json offsets_of(const DataFolder& folder, std::size_t shard);

/// Packs samples into shards and removes the samples. Beside each shard is an offset index (shard-000000.json: key ->
/// file -> [offset, bytes]), and key_to_shard.json states in which shard each image is. Shards that were packed before
/// are kept: a run that was killed at any time continues from there. Throws Error.
class ShardPacker {
 public:
  /// @param done  heaps that are made, or given up
  ShardPacker(const DataFolder& folder, const DataSetFacts& facts, std::set<std::size_t> done);
  /// Packs the shards that are whole with it: they can be read while the others are made.
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

/// Writes files as a tar whose bytes depend on names and contents alone; returns where each file's contents begin.
std::vector<std::pair<std::size_t, std::size_t>> write_tar(
    const std::string& path, const std::vector<std::pair<std::string, std::filesystem::path>>& files);

using ShardImages = std::map<std::string, std::map<std::string, std::string>>;  ///< key -> file -> contents
/// Everything in a shard; none if it is cut off or no tar. `doubled` is set if a file is there twice.
std::optional<ShardImages> read_tar(const std::string& path, bool& doubled);

}  // namespace bin_scenes
