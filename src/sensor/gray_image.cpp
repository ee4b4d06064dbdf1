#include "bin_scenes/sensor/gray_image.hpp"

#include "bin_scenes/core/error.hpp"
#include "bin_scenes/sensor/sensor_model.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes {

std::vector<std::uint8_t> gray_of(const RangeImage& image) {
  if (!image.gray.empty()) return image.gray;
  if (sensor_model(image.sensor.model).gray)
    throw input_error("the image has no grey image", "sensor " + image.sensor.name,
                      "set Generator::Options::gray to compute it");
  std::vector<std::uint8_t> levels;
  levels.reserve(image.intensity.size());
  for (const float value : image.intensity) {
    levels.push_back(std::isfinite(value) ? static_cast<std::uint8_t>(255.0f * std::clamp(value, 0.0f, 1.0f) + 0.5f)
                                          : 0);
  }
  return levels;
}

}  // namespace bin_scenes
