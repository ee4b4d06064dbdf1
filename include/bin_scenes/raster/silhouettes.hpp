/// Silhouettes: the pixels that a part would cover in a view if it were alone in the scene. The visible fraction of a
/// part is its visible pixels divided by its silhouette, and BOP's amodal masks are silhouettes.
#pragma once

#include "bin_scenes/raster/view.hpp"

#include <cstdint>
#include <vector>

namespace bin_scenes {

/// A mask with one bit for each pixel of a rectangle of the image.
struct Silhouette {
  int left = 0, top = 0, width = 0, height = 0;  ///< the rectangle (pixels); empty for a part that is not in the image
  std::size_t count = 0;                         ///< number of set bits
  std::vector<std::uint64_t> bits;  ///< rows of (width + 63) / 64 words; the lowest bit is the leftmost pixel

  std::size_t words_per_row() const { return static_cast<std::size_t>(width + 63) / 64; }
  bool at(int column, int row) const;  ///< coordinates of the whole image; false outside the rectangle
};

/// Returns the silhouettes of all parts, by index into Scene::parts. A silhouette contains all pixels of `view` that
/// show the part. @param near, far  depths (m) that bound what is seen
std::vector<Silhouette> silhouettes(const Scenery& scenery, const View& view, double near, double far);

/// A view together with the silhouettes.
struct SeenWithMasks {
  View view;
  std::vector<Silhouette> alone;
};
/// Calls render() and silhouettes() together, in one pass over the triangles if possible.
SeenWithMasks see(const Scenery& scenery, const Lens& lens, const Pose& pose, double near, double far);

}  // namespace bin_scenes
