#include "sensor/models/ideal.hpp"

#include "core/in_parallel.hpp"

#include <cmath>
#include <limits>

namespace bin_scenes {

RangeImage measure_ideal(View&& view) {
  RangeImage image;
  const std::size_t pixels = view.depth.size();
  image.label = std::move(view.label);
  image.normal = std::move(view.normal);
  image.depth.resize(pixels);
  image.intensity.resize(pixels);
  image.validity.resize(pixels);
  image.snr.assign(pixels, std::numeric_limits<float>::infinity());  // there is no noise
  const auto width = static_cast<std::size_t>(view.lens.width);
  in_parallel(static_cast<std::size_t>(view.lens.height), [&](std::size_t row) {
    for (std::size_t i = row * width; i < (row + 1) * width; ++i) {
      image.depth[i] = static_cast<float>(view.depth[i]);
      const bool seen = !std::isnan(view.depth[i]);
      image.validity[i] = static_cast<std::uint8_t>(seen ? Validity::valid : Validity::nothing);
      if (!seen) continue;
      const Vec3 ray = view.lens.ray(static_cast<double>(i - row * width), static_cast<double>(row));
      const auto& n = image.normal[i];
      image.intensity[i] = static_cast<float>(-Vec3(n[0], n[1], n[2]).dot(ray) / ray.norm());
    }
  });
  return image;
}

}  // namespace bin_scenes
