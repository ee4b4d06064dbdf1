/// Verifies a data set: whether all files are present and unchanged, whether they have the right formats, and whether
/// the labels agree with the geometry.
#pragma once

#include "bin_scenes/config/scene_file.hpp"
#include "dataset/data_folder.hpp"

#include <nlohmann/json.hpp>

#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace bin_scenes {

struct BopModel {
  std::vector<Vec3> vertices;  ///< mm
};

struct Finding {
  std::string check, where, text;
};

/// Collects findings; for several threads.
class Findings {
 public:
  /// Counts a check, and a finding if it fails. Returns whether it holds.
  bool expect(bool holds, const char* check, const std::string& where, const std::string& text);
  std::vector<Finding> sorted() const;
  std::map<std::string, std::size_t> checked() const { return checked_; }

 private:
  std::mutex mutex_;
  std::vector<Finding> all_;
  std::map<std::string, std::size_t> checked_;  ///< number of tests of each invariant
};

/// Every invariant by name, with what it demands: for `dataset verify --list` and the documentation.
const std::vector<std::pair<const char*, const char*>>& invariants();

/// Reads every file of the data set.
void verify_dataset(const DataFolder& folder, Findings& findings);

/// The JSON map in a file; none if it is missing or damaged.
std::optional<nlohmann::json> json_map_in(const std::filesystem::path& path);

// The parts of it.
void verify_index(const DataFolder& folder, const DataSetFacts& facts, Findings& findings);
/// One folder against its files.json.
void verify_files(const std::filesystem::path& folder, Findings& findings);
void verify_scene(const DataFolder& folder, const DataSetFacts& facts, std::size_t scene, Findings& findings);
void verify_bop(const DataFolder& folder, const DataSetFacts& facts, std::size_t number, const SceneFile& scene,
                const std::map<int, BopModel>& models, Findings& findings);
void verify_shards(const DataFolder& folder, const DataSetFacts& facts, Findings& findings);

std::map<int, BopModel> verify_models(const DataFolder& folder, Findings& findings);

}  // namespace bin_scenes
