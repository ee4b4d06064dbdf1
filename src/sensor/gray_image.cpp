#include "bin_scenes/sensor/gray_image.hpp"

#include "bin_scenes/core/error.hpp"
#include "bin_scenes/sensor/sensor_model.hpp"
#include "sensor/models/exposure.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace bin_scenes {

std::vector<std::uint8_t> gray_of(const RangeImage& image) {
  if (!image.gray.empty()) return image.gray;
  if (sensor_model(image.sensor.model).gray)
    throw input_error("the image has no grey image", "sensor " + image.sensor.name,
                      "set Generator::Options::gray to compute it");
  std::vector<float> light;
  light.reserve(image.intensity.size());
  for (const float value : image.intensity)
    light.push_back(std::isfinite(value) ? std::clamp(value, 0.0f, 1.0f) : 0.0f);
  if (image.picture.channels == 0)
    return exposed_for_parts(std::move(light), image.label, image.width, Imager(image.sensor.imager, false),
                             Random(0, 0, Stream::noise));
  std::vector<std::uint8_t> levels;
  levels.reserve(light.size());
  for (const float value : light) levels.push_back(static_cast<std::uint8_t>(255.0f * value + 0.5f));
  return levels;
}

}  // namespace bin_scenes
