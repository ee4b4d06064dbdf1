/// Writes the files that readers of BOP expect in addition to the scenes: cameras, targets of evaluations, and a
/// description of the data set.
#pragma once

#include "bop/layout.hpp"

#include <map>
#include <string>
#include <vector>

namespace bin_scenes {

/// The folder of a data set in BOP's layout by scenes, and what decides its files.
struct BopFolder {
  std::filesystem::path root;
  BopLayout layout = {};
  double tolerance = 0.0;        ///< m, of visible pixels by measured depth; 0: they are those of the true image
  bool run_lengths = false;      ///< masks are run lengths in JSON files instead of PNG files
  std::size_t most_targets = 0;  ///< visible parts of an image that is a target; 0: any number
  std::string version = {};      ///< of the program that made it
  std::vector<std::string> splits = {};  ///< at least one
  std::vector<Sensor> sensors =
      {};                        ///< of the first scene; other scenes differ in poses only. Empty: there is no scene
  std::string first_split = {};  ///< that of this scene

  std::filesystem::path scene(const std::string& split, std::size_t number) const {
    return root / split / six_digits(number);
  }
  /// Numbers of the scenes of a split, ascending.
  std::vector<std::size_t> scenes(const std::string& split) const;
  std::filesystem::path models() const { return root / "models"; }
  std::filesystem::path models_eval() const { return root / "models_eval"; }
};

/// Text by name of the file in the root, as the scenes that are there imply it: camera*.json, dataset_info.json and
/// test_targets_*.json of the split `test`, else `val`, else the first one.
std::map<std::string, std::string> bop_root_files(const BopFolder& folder);
void write_bop_root(const BopFolder& folder);

/// What has to go into bop_toolkit_lib/dataset_params.py for its scripts to know the data set as `name`: three pieces
/// of Python, each below a comment that says where. Throws an input Error for a folder that is not finished.
std::string toolkit_entry(const BopFolder& folder, const std::string& name);

/// Returns a warning if a target image has more visible parts than bop_toolkit keeps estimates of an image (100, and
/// 200 for the data set xyzibd). The text is empty if there is no such image.
std::string crowded_targets(const BopFolder& folder, const std::string& name = "");

}  // namespace bin_scenes
