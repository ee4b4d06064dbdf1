/// Reads images and masks of BOP scenes of any origin, as they are stored: as PNG files, or as run lengths in JSON
/// files. The poses and cameras are read by bop_reader.hpp.
#pragma once

#include "dataset/bop_reader.hpp"

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace bin_scenes {

/// A mask of the size of its image.
struct BinaryImage {
  int width = 0, height = 0;
  std::vector<std::uint8_t> inside;  ///< row-major, 0 or 1

  bool at(int x, int y) const {
    return x >= 0 && y >= 0 && x < width && y < height &&
           inside[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)] != 0;
  }
  std::size_t count() const;
};

/// Run lengths as COCO has them, column by column, the first run of zeros. `json`: {"size": [height, width], "counts":
/// a list, or the compressed text of pycocotools}. Throws an input Error at `where`.
BinaryImage from_run_lengths(const std::string& json, const std::string& where);

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

/// Path of the file with the run lengths of all masks of a scene: {image: {entry: {size, counts}}}.
std::filesystem::path run_lengths_file(const std::filesystem::path& scene, const std::string& kind,
                                       const std::string& suffix);

}  // namespace bin_scenes
