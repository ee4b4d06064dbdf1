/// The sensor model `ideal`: exact depth at pixel centres, without noise or occlusion of light. It serves as ground
/// truth beside the other models.
#pragma once

#include "bin_scenes/sensor/models.hpp"

namespace bin_scenes {

RangeImage measure_ideal(View&& view);

}  // namespace bin_scenes
