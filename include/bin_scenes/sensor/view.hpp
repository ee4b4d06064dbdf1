/// Exact depth, part id and normal of each pixel for a pose and a lens, without any sensor effect.
#pragma once

#include "bin_scenes/sensor/lens.hpp"
#include "bin_scenes/sensor/scenery.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace bin_scenes {

/// Row-major, lens.width * lens.height; one ray through each pixel's centre (no anti-aliasing, so no points between
/// near and far surfaces). Optical frame of the lens.
struct View {
  Lens lens;
  Pose pose;                                 ///< optical frame in the bin frame
  std::vector<double> depth;                 ///< z along the optical axis (m); NaN: nothing between near and far
  std::vector<std::uint16_t> label;          ///< 0 of the bin and of nothing, id + 1 of a part
  std::vector<std::array<float, 3>> normal;  ///< of the face, unit, towards the lens; NaN where depth is
  std::vector<std::uint32_t> face;           ///< Scenery::Face
  std::vector<std::int32_t> line;            ///< index into Request::parts; -1 of the bin and of nothing
};

/// @param pose  optical frame in the bin frame
/// @param near, far  depths (m) that bound what is seen
View render(const Scenery& scenery, const Lens& lens, const Pose& pose, double near, double far);
/// The same with one ray for each pixel, for any lens; slower.
View cast(const Scenery& scenery, const Lens& lens, const Pose& pose, double near, double far);

}  // namespace bin_scenes
