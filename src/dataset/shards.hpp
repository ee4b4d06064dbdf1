/// BOP's layout by images: tar files of at most a thousand images each, as WebDataset reads them.
#pragma once

#include "dataset/data_folder.hpp"

#include <string>
#include <utility>
#include <vector>

namespace bin_scenes {

constexpr std::size_t images_per_shard = 1000;

/// Scenes of a shard: a fixed range, so that a shard does not depend on what others hold. Where heaps have failed, it
/// has fewer images.
std::size_t scenes_per_shard(const DataSetFacts& facts);
std::size_t shard_of(const DataSetFacts& facts, std::size_t scene);
std::size_t shard_count(const DataSetFacts& facts);

/// Packs samples into shards, with an offset index beside each (shard-000000.json: key -> file -> [offset, bytes]),
/// then writes key_to_shard.json and removes the samples. What was packed before is kept; killed at any instant, it
/// goes on from there. Throws Error.
void pack_shards(const DataFolder& folder, const DataSetFacts& facts);

/// Writes files as a tar whose bytes depend on names and contents alone; returns where each file's contents begin.
std::vector<std::pair<std::size_t, std::size_t>> write_tar(
    const std::string& path, const std::vector<std::pair<std::string, std::filesystem::path>>& files);

}  // namespace bin_scenes
