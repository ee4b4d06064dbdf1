/// The texture of a worn surface. Scratches, oil and rust are grains at random places in the frame of the part, which
/// its surface cuts. The share of space that their union covers has a closed form: 1 - exp(-grains per volume * volume
/// of a grain) (the Boolean model; Chiu, Stoyan, Kendall, Mecke 2013, "Stochastic geometry and its applications",
/// chapter 3).
#pragma once

#include "bin_scenes/scene/request.hpp"

#include <cstdint>

namespace bin_scenes {

/// Returns the surface with wear at a point. @param point  in the frame of the part (m)
/// @param key    random key of the part
Surface worn(Surface surface, const Vec3& point, std::uint64_t key);

}  // namespace bin_scenes
