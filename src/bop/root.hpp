/// Writes the files that readers of BOP expect in addition to the scenes: cameras, targets of evaluations, and a
/// description of the data set.
#pragma once

#include "bop/layout.hpp"

#include <map>
#include <string>
#include <vector>

namespace bin_scenes {

/// The folder of a data set in BOP's layout by scenes, and the settings on which its files depend.
struct BopFolder {
  std::filesystem::path root;
  BopLayout layout = {};
  double tolerance = 0.0;    ///< m, tolerance of visible pixels by measured depth; 0: they are those of the true image
  bool run_lengths = false;  ///< masks are run lengths in JSON files instead of PNG files
  std::size_t most_targets = 0;          ///< largest number of visible parts in a target image; 0: no limit
  std::string version = {};              ///< version of the program that made the data set
  std::vector<std::string> splits = {};  ///< names of the splits, at least one
  std::vector<Sensor> sensors =
      {};  ///< sensors of the first scene; other scenes differ in poses only. Empty: no scene exists
  std::string first_split = {};  ///< split of the first scene

  std::filesystem::path scene(const std::string& split, std::size_t number) const {
    return root / split / six_digits(number);
  }
  /// Returns the numbers of the scenes of a split, in ascending order.
  std::vector<std::size_t> scenes(const std::string& split) const;
  std::filesystem::path models() const { return root / "models"; }
  std::filesystem::path models_eval() const { return root / "models_eval"; }
};

/// Returns the text of each file in the root folder, by file name, as it follows from the existing scenes:
/// camera*.json, dataset_info.json and test_targets_*.json of the split `test`, else `val`, else the first one.
std::map<std::string, std::string> bop_root_files(const BopFolder& folder);
void write_bop_root(const BopFolder& folder);

/// Returns the text to add to bop_toolkit_lib/dataset_params.py, so that its scripts know the data set as `name`: three
/// pieces of Python, each below a comment that states the place. Throws an input Error for an unfinished folder.
std::string toolkit_entry(const BopFolder& folder, const std::string& name);

/// Returns a warning if a target image has more visible parts than bop_toolkit keeps estimates of an image (100, and
/// 200 for the data set xyzibd). The text is empty if there is no such image.
std::string crowded_targets(const BopFolder& folder, const std::string& name = "");

}  // namespace bin_scenes
