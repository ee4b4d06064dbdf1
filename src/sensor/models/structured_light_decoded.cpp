#include "core/in_parallel.hpp"
#include "sensor/models/structured_light_samples.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace bin_scenes {

Measurement StructuredLight::decoded(const Random& random) const {
  Measurement out(view_.depth.size());
  const bool keep = setup_.settings.mixed == MixedPixels::keep;
  constexpr int n = Samples::per_pixel;
  in_parallel(static_cast<std::size_t>(view_.lens.height), [&](std::size_t row) {
    std::vector<Pixel> pixels;
    for (const Pixel& pixel : lit_row(row)) {
      out.validity[pixel.index] = pixel.lit.code;
      if (pixel.lit.code == Validity::valid) pixels.push_back(pixel);
    }
    Samples samples;
    sample(pixels, samples);

    Random draw = random.of_piece(row);
    std::vector<float> images(static_cast<std::size_t>(fringes_.images()));
    for (std::size_t p = 0; p < pixels.size(); ++p) {
      double ambient = 0.0;
      for (int k = 0; k < n; ++k) {
        const SeenPoint& point = samples.points[n * p + k];
        if (point.hit) ambient += setup_.imager.ambient * diffuse_share(surfaces_.of(point.line)) / n;
      }
      std::fill(images.begin(), images.end(), static_cast<float>(ambient));
      for (int k = 0; k < n; ++k) {
        const Lit& l = samples.lit[n * p + k];
        if (l.code != Validity::valid) continue;
        fringes_.add_light(l.column, gain_ * l.reflected / (l.distance * l.distance) / n, images.data());
      }
      imager_.expose(images.data(), images.size(), draw);

      const std::size_t i = pixels[p].index;
      const auto shifts = images.begin() + setup_.settings.steps;
      out.intensity[i] = std::accumulate(images.begin(), shifts, 0.0f) / static_cast<float>(setup_.settings.steps);
      const Fringes::Reading reading = fringes_.read(images.data());
      if (samples.mixed[p] && !keep) {
        out.validity[i] = Validity::mixed;
      } else if (imager_.saturated(*std::max_element(images.begin(), shifts))) {
        out.validity[i] = Validity::saturated;
      } else if (reading.modulation < setup_.settings.min_modulation) {
        out.validity[i] = Validity::dark;
      } else if (std::isnan(reading.column)) {
        out.validity[i] = Validity::decoding;
      } else {
        deliver(out, pixels[p], reading.column);
      }
    }
  });
  return out;
}

}  // namespace bin_scenes
