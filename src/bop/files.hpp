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

/// The masks of one kind ("mask" or "mask_visib") of one view.
class BopMasks {
 public:
  BopMasks(const BopView& view, std::string kind);
  /// Returns none if there is neither a file nor an entry.
  std::optional<BinaryImage> of(std::size_t entry) const;
  /// Returns the path of the file, whether it exists or not.
  std::string place(std::size_t entry) const;

 private:
  const BopView& view_;
  std::string kind_;
  std::filesystem::path run_lengths_file_;
  std::map<std::size_t, std::string> run_lengths_;  ///< JSON by entry; empty: there are PNG files
};

/// Kinds of images and masks that the folder of a scene has for a view: "rgb", "gray", "depth", "mask", "mask_visib"
/// and so on, without suffix.
std::vector<std::string> bop_kinds(const BopView& view);
/// Whether an image of a kind that is not a mask is there, whatever its extension.
bool has_image(const BopView& view, const std::string& kind);

/// The depth image as it is stored (m, 0 = not measured); none if there is no such file, or none that can be read.
struct BopDepth {
  int width = 0, height = 0;
  std::vector<float> depth;
};
std::optional<BopDepth> depth_of(const BopView& view);

}  // namespace bin_scenes
