/// Exact depth at pixel centres.
#pragma once

#include "bin_scenes/sensor/models.hpp"

namespace bin_scenes {

RangeImage measure_ideal(View&& view);

}  // namespace bin_scenes
