/// The work of one worker process: it makes heaps of a plan one after the other and writes each scene into a folder.
/// Which heap comes next is decided by the parent process (workers.hpp).
#pragma once

#include "bin_scenes/core/error.hpp"
#include "bin_scenes/generate/generator.hpp"
#include "bop/image.hpp"
#include "dataset/data_folder.hpp"
#include "dataset/record.hpp"
#include "dataset/whole_folders.hpp"

#include <map>
#include <optional>
#include <string>
#include <tuple>

namespace bin_scenes {

class HeapMaker {
 public:
  /// @param first  number of the first heap; if it fails twice for the same reason, the fault is one of the plan
  HeapMaker(const Plan& plan, const DataFolder& folder, std::size_t first)
      : plan_(plan), folder_(folder), facts_(facts_of(plan)), first_(first) {}

  /// Pours a heap and writes its scenes: all of them or none. An attempt that is not accepted is set apart with its
  /// request and reasons, and another attempt follows. Throws an environment Error if the machine fails, and an input
  /// Error if two attempts of the first heap fail for the same reason: the plan is at fault then.
  HeapRecord make(std::size_t heap);

 private:
  struct Attempt {
    std::optional<Request> request;
    std::optional<Generator::Result> result;  ///< the last scene that was made
    std::vector<std::string> reasons;  ///< why it was not accepted; empty: its scenes are ready in hidden folders
    std::optional<Error> fault;        ///< an error that may be one of the plan
    bool crowded = false;              ///< the fault is that too many parts were not poured
    std::size_t scenes = 0;

    bool fails_like(const Attempt& other) const;
  };
  Attempt attempt(std::size_t heap, std::size_t attempt, HeapRecord& record, WholeFolders& folders);
  void make_scenes(std::size_t heap, std::size_t attempt, Attempt& out, HeapRecord& record, WholeFolders& folders);
  std::optional<Error> crowd(const Scene& scene) const;
  void write_scene(const Generator::Result& result, const LoadedRequest& loaded, const std::vector<BopImage>& bop,
                   std::size_t scene, WholeFolders& folders);
  void set_apart(const Attempt& failed, std::size_t heap, std::size_t attempt);
  std::vector<int> object_ids(const Request& request) const;
  double volume_of(const PartLine& line);

  const Plan& plan_;
  DataFolder folder_;
  DataSetFacts facts_;
  std::size_t first_;
  Generator generator_;
  /// Identifies what is loaded from a model file: its digest and all settings. Heaps must not depend on earlier heaps.
  using Model = std::tuple<std::string, std::optional<Unit>, double, std::optional<double>, std::optional<double>,
                           double, std::string>;
  std::map<Model, double> volumes_;  ///< volume of one part of each model (m3)
};

/// Returns the record of a heap from its files, if all of them exist. It serves data sets whose index is lost or
/// incomplete.
std::optional<HeapRecord> found_on_disk(const DataFolder& folder, const DataSetFacts& facts, std::size_t heap);

/// Writes the models in BOP's layout, with their symmetries.
void write_models(const Plan& plan, const DataFolder& folder);

}  // namespace bin_scenes
