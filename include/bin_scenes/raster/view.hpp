/// The exact view of a camera: depth, part and normal of each pixel for a pose and a lens, without any sensor effect.
/// Sensor models start from it, and the true images are made of it.
#pragma once

#include "bin_scenes/raster/lens.hpp"
#include "bin_scenes/raster/scenery.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace bin_scenes {

/// Row-major images of lens.width * lens.height pixels in the optical frame of the lens. One ray passes through the
/// centre of each pixel. There is no anti-aliasing, and therefore no point between near and far surfaces.
struct View {
  Lens lens;
  Pose pose;                                 ///< from the optical frame to the bin frame
  std::vector<double> depth;                 ///< z along the optical axis (m); NaN if nothing is between near and far
  std::vector<std::uint16_t> label;          ///< id + 1 of a part; 0 for the bin and for nothing
  std::vector<std::array<float, 3>> normal;  ///< unit normal of the face towards the lens; NaN where depth is NaN
  std::vector<std::uint32_t> face;           ///< number of the face (Scenery::Face)
  std::vector<std::int32_t> line;            ///< as Hit::line
};

/// Makes a view, by drawing the triangles where possible.
/// @param pose  from the optical frame to the bin frame
/// @param near, far  depths (m) that bound what is seen
View render(const Scenery& scenery, const Lens& lens, const Pose& pose, double near, double far);
/// Makes the same view with one ray for each pixel, for any lens; slower.
View cast(const Scenery& scenery, const Lens& lens, const Pose& pose, double near, double far);

}  // namespace bin_scenes
