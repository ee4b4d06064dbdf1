/// A view whose triangles are drawn: what a ray through each pixel's centre would meet, in double precision, at a
/// fraction of the time, and each part's silhouette with it. Triangles are few, and pixels many.
#pragma once

#include "bin_scenes/sensor/silhouettes.hpp"

#include <optional>
#include <vector>

namespace bin_scenes {

/// None where rays have to see: lines do not stay straight, or a mesh reaches through the plane of the lens, or a part
/// lies partly out of range and its silhouette is asked for.
/// @param alone  set to the silhouettes by index into Scene::parts; nullptr: nobody asks
std::optional<View> drawn(const Scenery& scenery, const Lens& lens, const Pose& pose, double near, double far,
                          std::vector<Silhouette>* alone);

}  // namespace bin_scenes
