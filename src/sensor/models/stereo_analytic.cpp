/// The analytic form of stereo: which pixels are matched, and by how much their disparities err, by formulas.
#include "core/in_parallel.hpp"
#include "sensor/models/census_expected.hpp"
#include "sensor/models/disparity_filters.hpp"
#include "sensor/models/noise_field.hpp"
#include "sensor/models/stereo.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace bin_scenes {

/// What can be matched without dots: borders of albedo, shadow and texture.
std::vector<char> Stereo::surface_texture() const {
  const std::vector<float> values = signals(view_, lit_, haze_);
  std::vector<std::uint8_t> bytes(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    bytes[i] = static_cast<std::uint8_t>(std::lround(255.0f * std::min(values[i], 1.0f)));
  }
  return textured(bytes, view_.lens.width, view_.lens.height, setup_.settings, imager_);
}

/// Whether the second camera does not see what each pixel of a row of the first one sees.
std::vector<std::uint8_t> Stereo::hidden_from_second(std::size_t row) const {
  const auto width = static_cast<std::size_t>(view_.lens.width);
  std::vector<Ray> rays(width);
  std::vector<std::uint8_t> hidden(width);
  for (std::size_t x = 0; x < width; ++x) {
    const SeenPoint point = seen_point(view_, row * width + x);
    if (point.hit)
      rays[x] = ray_between(point.position, point.normal, second_.position);
    else
      rays[x].direction = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  }
  scenery_.blocked(rays.data(), hidden.data(), width);
  return hidden;
}

/// Signal, SNR and code of each pixel. Of those that can be matched the true disparity (pixel), NaN of the others, and
/// the standard deviation of the noise of its disparity (pixel).
Stereo::Matchable Stereo::matchable(Measurement& out) const {
  const StereoSettings& s = setup_.settings;
  const auto width = static_cast<std::size_t>(view_.lens.width);
  Matchable found{std::vector<float>(view_.depth.size(), std::numeric_limits<float>::quiet_NaN()),
                  std::vector<float>(view_.depth.size(), 0.0f)};
  const std::vector<char> texture = s.dots > 0.0 ? std::vector<char>() : surface_texture();
  if (setup_.gray) out.light = even_light();
  in_parallel(static_cast<std::size_t>(view_.lens.height), [&](std::size_t row) {
    const std::vector<std::uint8_t> hidden = hidden_from_second(row);
    for (std::size_t x = 0; x < width; ++x) {
      const std::size_t i = row * width + x;
      out.validity[i] = lit_[i].code == Validity::nothing ? Validity::nothing : Validity::unmatched;
      double signal = lit_[i].code == Validity::valid ? white(lit_[i]) : 0.0;
      double over = background(i);
      out.intensity[i] = static_cast<float>(std::min(signal + over, 1.0));
      const double scale = scale_of(signal + over);
      signal *= scale, over *= scale;
      out.snr[i] = static_cast<float>(signal / std::sqrt(imager_.variance(signal + over)));
      const double truth = of_disparity(view_.depth[i]);
      const bool in_second = static_cast<double>(x) - truth >= 0.0 && truth < of_disparity(setup_.far) + s.disparities;
      if (hidden[x] || !in_second || signal < s.min_signal || (!texture.empty() && !texture[i])) continue;
      if (imager_.saturated(signal + over)) {
        out.validity[i] = Validity::saturated;
        continue;
      }
      out.validity[i] = Validity::valid;
      found.disparity[i] = static_cast<float>(truth);
      found.sigma[i] = static_cast<float>(disparity_sigma(signal, over));
    }
  });
  return found;
}

Measurement Stereo::analytic(const Random& random) const {
  Measurement out(view_.depth.size());
  Matchable found = matchable(out);
  if (!setup_.noise) {
    for (std::size_t i = 0; i < out.depth.size(); ++i)
      if (out.validity[i] == Validity::valid) out.depth[i] = view_.depth[i];
    return out;
  }
  const int width = view_.lens.width, height = view_.lens.height;
  const bool census = setup_.pipeline.matcher == StereoMatcher::census;
  if (census) {
    const ExpectedCensus matcher(setup_.settings, setup_.pipeline, setup_.projector.fx / view_.lens.fx);
    matcher.match(width, height, random.of_piece(1), found.disparity);
  }
  const double kept = temporally_filtered_noise(setup_.pipeline.temporal);
  const std::vector<float> field = correlated_noise(width, height, noise_window(), random);
  for (std::size_t i = 0; i < field.size(); ++i) {
    found.disparity[i] += static_cast<float>(kept) * found.sigma[i] * field[i];
    if (out.validity[i] == Validity::valid && std::isnan(found.disparity[i])) out.validity[i] = Validity::unmatched;
  }
  decimate(found.disparity, out);
  filter_one(found.disparity);
  return deliver(std::move(found.disparity), std::move(out));
}

/// Width of the window (pixel) whose noise a disparity averages. A signature weights the noise of its centre most.
double Stereo::noise_window() const {
  const int window = setup_.settings.window;
  return setup_.pipeline.matcher == StereoMatcher::census ? 0.5 * (window + 1) : window;
}

}  // namespace bin_scenes
