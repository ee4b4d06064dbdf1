/// Makes a view by drawing triangles (rasterisation) instead of casting rays. The result is what a ray through the
/// centre of each pixel would meet, in double precision and in a fraction of the time, together with the silhouette of
/// each part. It is faster because a scene has fewer triangles than pixels; it requires a lens without distortion.
#pragma once

#include "bin_scenes/raster/silhouettes.hpp"

#include <optional>
#include <vector>

namespace bin_scenes {

/// Returns none if rays must be cast instead: if lines do not stay straight, if a mesh reaches through the plane of the
/// lens, or if a part is partly out of range and its silhouette is requested.
std::optional<View> drawn(const Scenery& scenery, const Lens& lens, const Pose& pose, double near, double far,
                          std::vector<Silhouette>* alone);

}  // namespace bin_scenes
