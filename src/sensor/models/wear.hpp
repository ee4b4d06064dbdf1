/// Texture of a surface: scratches, oil and rust as grains of random place in the part's frame, cut by its surface.
/// Their union covers a share of space that has a closed form: 1 - exp(-grains per volume * volume of one) (the Boolean
/// model, Chiu, Stoyan, Kendall, Mecke 2013, "Stochastic geometry and its applications", chapter 3).
#pragma once

#include "bin_scenes/scene/request.hpp"

#include <cstdint>

namespace bin_scenes {

/// @param point  part's frame
/// @param key    of the part
Surface worn(Surface surface, const Vec3& point, std::uint64_t key);

}  // namespace bin_scenes
