/// Verifies a data set: whether all files are present and unchanged, whether they have the right formats, and whether
/// the labels agree with the geometry.
#pragma once

#include "bin_scenes/config/scene_file.hpp"
#include "core/findings.hpp"
#include "dataset/data_folder.hpp"

#include <string>
#include <vector>

namespace bin_scenes {

/// Returns all invariants by name with a description, for `dataset verify --list` and the documentation.
const std::vector<std::pair<const char*, const char*>>& invariants();

/// Checks every file of the data set.
void verify_dataset(const DataFolder& folder, Findings& findings);

// The steps of verify_dataset().
void verify_index(const DataFolder& folder, const DataSetFacts& facts, Findings& findings);
/// Compares one folder with its files.json.
void verify_files(const std::filesystem::path& folder, Findings& findings);
void verify_scene(const DataFolder& folder, const DataSetFacts& facts, std::size_t scene, Findings& findings);
void verify_shards(const DataFolder& folder, const DataSetFacts& facts, Findings& findings);

}  // namespace bin_scenes
