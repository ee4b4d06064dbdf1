/// The surface of the table below the bin, with light and dark patches.
#pragma once

#include "bin_scenes/scene/request.hpp"

#include <cstdint>

namespace bin_scenes {

/// Returns the surface of the table at a point (m, bin frame). @param key  random key of the patches
Surface table_surface(const Table& table, const Vec3& point, std::uint64_t key);

}  // namespace bin_scenes
