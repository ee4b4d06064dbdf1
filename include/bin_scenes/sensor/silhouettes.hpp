/// Silhouettes: the pixels that a part would have in a view if it were alone in the scene.
#pragma once

#include "bin_scenes/sensor/view.hpp"

#include <cstdint>
#include <vector>

namespace bin_scenes {

/// One bit a pixel of a rectangle of the image.
struct Silhouette {
  int left = 0, top = 0, width = 0, height = 0;  ///< rectangle (pixels); empty for a part that is not seen
  std::size_t count = 0;                         ///< bits that are set
  std::vector<std::uint64_t> bits;               ///< rows of (width + 63) / 64 words, lowest bit leftmost

  std::size_t words_per_row() const { return static_cast<std::size_t>(width + 63) / 64; }
  bool at(int column, int row) const;  ///< of the whole image; false outside the rectangle
};

/// The silhouettes of all parts, by index into Scene::parts. They contain all pixels of `view` that show the part.
std::vector<Silhouette> silhouettes(const Scenery& scenery, const View& view, double near, double far);

/// render() and silhouettes() together, in one pass over the triangles where possible.
struct SeenWithMasks {
  View view;
  std::vector<Silhouette> alone;
};
SeenWithMasks see(const Scenery& scenery, const Lens& lens, const Pose& pose, double near, double far);

}  // namespace bin_scenes
