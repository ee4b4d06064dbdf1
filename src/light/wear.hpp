/// The texture of a worn surface. Scratches, oil and rust are modelled as grains at random positions in the volume of
/// the part, which appear where its surface cuts them. Their union covers the share 1 - exp(-grains per volume * volume
/// of a grain) of space (the Boolean model; Chiu, Stoyan, Kendall, Mecke 2013, "Stochastic geometry and its
/// applications", chapter 3).
#pragma once

#include "bin_scenes/scene/request.hpp"

#include <cstdint>

namespace bin_scenes {

/// Returns the surface with wear at a point. @param point  in the frame of the part (m)
/// @param key    random key of the part
Surface worn(Surface surface, const Vec3& point, std::uint64_t key);

}  // namespace bin_scenes
