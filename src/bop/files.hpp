/// Reads images and masks of BOP scenes of any origin, as they are stored: as PNG files, or as run lengths in JSON
/// files. The poses and cameras are read by reader.hpp.
#pragma once

#include "bop/masks.hpp"
#include "bop/reader.hpp"

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace bin_scenes {

/// Reads the masks of one kind ("mask" or "mask_visib") of one view.
class BopMasks {
 public:
  BopMasks(const BopView& view, std::string kind);
  /// Returns the mask of an entry of scene_gt; none if it is stored neither as PNG file nor as run lengths.
  std::optional<BinaryImage> of(std::size_t entry) const;
  /// Returns the path of the file of an entry's mask, whether it exists or not.
  std::string place(std::size_t entry) const;

 private:
  const BopView& view_;
  std::string kind_;
  std::filesystem::path run_lengths_file_;
  std::map<std::size_t, std::string> run_lengths_;  ///< JSON of the run lengths by entry; empty: masks are PNG files
};

/// Returns the kinds of images and masks that the folder of a scene has for a view, without suffix: "rgb", "gray",
/// "depth", "mask", "mask_visib" and so on.
std::vector<std::string> bop_kinds(const BopView& view);
/// Returns whether the view has an image of a kind (other than masks), with any file extension.
bool has_image(const BopView& view, const std::string& kind);

/// The stored depth image (m, row-major; 0: not measured). depth_of() returns none if it is missing or not readable.
struct BopDepth {
  int width = 0, height = 0;
  std::vector<float> depth;
};
std::optional<BopDepth> depth_of(const BopView& view);

}  // namespace bin_scenes
