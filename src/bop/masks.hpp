/// Masks of parts, as boxes and as whole images, and the forms in which BOP's files hold them: PNG files, and run
/// lengths as COCO has them: column by column from the left, each from the top; the first run is one of zeros.
#pragma once

#include "output/boxes.hpp"
#include "output/png.hpp"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace bin_scenes {

/// A mask that is stored only within a rectangle of the image (pixels); pixels outside of it are 0.
struct MaskBox {
  int left = 0, top = 0, width = 0, height = 0;
  std::vector<std::uint8_t> inside;  ///< row-major, 0 or 1
};
/// Returns the pixels in the box of a part that show the part in the true image.
MaskBox visible_mask(const RangeImage& image, int id, const PixelBox& box);
MaskBox whole_mask(const Silhouette& silhouette);

/// A mask that is stored for all pixels of the image.
struct BinaryImage {
  int width = 0, height = 0;
  std::vector<std::uint8_t> inside;  ///< row-major, 0 or 1

  bool at(int x, int y) const {
    return x >= 0 && y >= 0 && x < width && y < height &&
           inside[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)] != 0;
  }
  std::size_t count() const;
};

/// Returns a PNG file of the whole image with 8 bits per pixel, 0 or 255. It is encoded fast where nearly all pixels
/// are 0, because a scene of a data set has hundreds of masks.
Bytes mask_png(int width, int height, const MaskBox& box);

std::vector<std::size_t> run_lengths(const MaskBox& mask, int width, int height);
/// Returns {entry: {counts, size}} for all masks, as in mask.json of BOP's layout by images.
nlohmann::ordered_json run_lengths_of(const std::vector<MaskBox>& masks, int width, int height);
/// Reads run lengths. `json`: {"size": [height, width], "counts": a list, or the compressed text of pycocotools}.
/// Throws an input Error that names `where`.
BinaryImage from_run_lengths(const std::string& json, const std::string& where);

}  // namespace bin_scenes
