#include "scene/palette.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes {

Vec3 part_colour(int id) {
  const double hue = 6.0 * std::fmod(0.08 + 0.6180339887498949 * id, 1.0);
  const double saturation = 0.42 + 0.09 * (id % 3), value = 0.97 - 0.07 * (id / 3 % 3);
  const auto channel = [&](double shift) {
    const double ramp = std::clamp(std::abs(std::fmod(hue + shift, 6.0) - 3.0) - 1.0, 0.0, 1.0);
    return value * (1.0 - saturation * (1.0 - ramp));
  };
  return {channel(0.0), channel(4.0), channel(2.0)};
}

}  // namespace bin_scenes
