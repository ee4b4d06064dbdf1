/// Writes the files that readers of BOP expect in addition to the scenes: cameras, targets of evaluations, and a
/// description of the data set.
#pragma once

#include "dataset/data_folder.hpp"

#include <map>
#include <string>

namespace bin_scenes {

/// Text by name of the file in DIR/bop, as the scenes that are there imply it: camera*.json, dataset_info.json and
/// test_targets_*.json of the split `test`, else `val`, else the first one.
std::map<std::string, std::string> bop_root_files(const DataFolder& folder, const DataSetFacts& facts);
void write_bop_root(const DataFolder& folder, const DataSetFacts& facts);

/// What has to go into bop_toolkit_lib/dataset_params.py for its scripts to know the data set as `name`: three pieces
/// of Python, each below a comment that says where. Throws an input Error without BOP's layout by scenes.
std::string toolkit_entry(const DataFolder& folder, const std::string& name);

/// A warning where target images have more visible parts than bop_toolkit keeps estimates of (twice as many of the data
/// set xyzibd); empty: there are none.
std::string crowded_targets(const DataFolder& folder, const std::string& name = "");

}  // namespace bin_scenes
