/// Takes the grain of few paths out of an image: each pixel becomes a mean of those around it that see the same face,
/// or one that bends on from it, and whose light differs by no more than grain explains (Dammertz et al. 2010,
/// "Edge-avoiding a-trous wavelet transform for fast global illumination filtering"; weights by variance: Schied et al.
/// 2017, "Spatiotemporal variance-guided filtering"). A pixel across which two faces meet takes the light that each has
/// beside it, by its share of the pixel.
#pragma once

#include "bin_scenes/sensor/view.hpp"
#include "sensor/models/path_tracer.hpp"

#include <vector>

namespace bin_scenes {

/// All by pixel.
void denoise(const View& view, const std::vector<PathTracer::Grain>& grain, std::vector<Rgb>& radiance);

}  // namespace bin_scenes
