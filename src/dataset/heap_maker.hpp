/// Makes heaps of a plan into folders, one after the other: what a worker does.
#pragma once

#include "bin_scenes/generate/generator.hpp"
#include "dataset/data_folder.hpp"
#include "dataset/record.hpp"
#include "dataset/whole_folders.hpp"
#include "output/bop_image.hpp"

#include <map>
#include <optional>
#include <string>

namespace bin_scenes {

class HeapMaker {
 public:
  HeapMaker(const Plan& plan, const DataFolder& folder) : plan_(plan), folder_(folder) {}

  /// Draws, pours and writes the heap's scenes. All of them appear, or none. An attempt that is not accepted is set
  /// apart with request and reason, and the next one is made. Throws Error of kind environment if the machine fails.
  HeapRecord make(std::size_t heap);

 private:
  /// Reasons why the attempt was not accepted; empty: its scenes wait in `folders`.
  std::vector<std::string> attempt(std::size_t heap, std::size_t attempt, HeapRecord& record, WholeFolders& folders);
  void write_scene(const Generator::Result& result, const Request& request, const std::vector<BopImage>& bop,
                   std::size_t scene, WholeFolders& folders);
  void set_apart(const Generator::Result* result, const Request* request, const std::vector<std::string>& reasons,
                 std::size_t heap, std::size_t attempt);
  std::vector<int> object_ids(const Request& request) const;
  double volume_of(const PartLine& line);

  const Plan& plan_;
  DataFolder folder_;
  Generator generator_;
  std::map<std::string, double> volumes_;  ///< m3, by digest and size of the model
};

/// What lies on the disk of a heap, if it is all there: for folders whose index is lost or behind.
std::optional<HeapRecord> found_on_disk(const DataFolder& folder, const DataSetFacts& facts, std::size_t heap);

/// The models of BOP's layouts, with symmetries.
void write_models(const Plan& plan, const DataFolder& folder);

}  // namespace bin_scenes
