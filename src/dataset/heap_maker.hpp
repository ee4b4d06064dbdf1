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
  /// @param first  heap by which faults of the plan are distinguished from faults of a draw
  HeapMaker(const Plan& plan, const DataFolder& folder, std::size_t first)
      : plan_(plan), folder_(folder), facts_(facts_of(plan)), first_(first) {}

  /// Draws, pours and writes the heap's scenes. All of them appear, or none. An attempt that is not accepted is set
  /// apart with request and reason, and the next one is made. Throws Error: of kind environment if the machine fails,
  /// of kind input if another draw of the first heap fails for the same reason, which no draw seems to cure then.
  HeapRecord make(std::size_t heap);

 private:
  struct Attempt {
    std::optional<Request> request;
    std::optional<Generator::Result> result;  ///< the last scene that was made
    std::vector<std::string> reasons;         ///< why it was not accepted; empty: its scenes wait in their folders
    std::optional<Error> fault;               ///< an error that may be one of the plan
    bool crowded = false;                     ///< the fault is that too many parts found no room
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
  /// Digest of the file, and all that decides what is loaded from it: heaps must not depend on those made before.
  using Model = std::tuple<std::string, std::optional<Unit>, double, std::optional<double>, std::optional<double>,
                           double, std::string>;
  std::map<Model, double> volumes_;  ///< m3
};

/// Returns the record of a heap from its files, if all of them exist. It serves data sets whose index is lost or
/// incomplete.
std::optional<HeapRecord> found_on_disk(const DataFolder& folder, const DataSetFacts& facts, std::size_t heap);

/// The models of BOP's layouts, with symmetries.
void write_models(const Plan& plan, const DataFolder& folder);

}  // namespace bin_scenes
