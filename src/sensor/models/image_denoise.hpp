/// Removes Monte Carlo noise from images that are made with few light paths. Each pixel becomes a weighted mean of the
/// pixels around it that see the same face, or a face that continues it, and whose radiance differs by no more than the
/// noise explains (Dammertz et al. 2010, "Edge-avoiding a-trous wavelet transform for fast global illumination
/// filtering"; weights by variance: Schied et al. 2017, "Spatiotemporal variance-guided filtering"). A pixel that two
/// faces share takes the radiance that each face has beside it, weighted by the share of the face in the pixel.
#pragma once

#include "bin_scenes/raster/view.hpp"
#include "light/path_tracer.hpp"

#include <vector>

namespace bin_scenes {

/// Denoises `radiance` in place. The arguments contain one value for each pixel, row-major.
void denoise(const View& view, const std::vector<PathTracer::Grain>& grain, std::vector<Rgb>& radiance);

}  // namespace bin_scenes
