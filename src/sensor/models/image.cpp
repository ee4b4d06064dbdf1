#include "sensor/models/image.hpp"

#include "core/in_parallel.hpp"
#include "light/bevel.hpp"
#include "light/path_tracer.hpp"
#include "sensor/models/image_denoise.hpp"
#include "sensor/models/image_optics.hpp"
#include "sensor/models/imager.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace bin_scenes {

namespace {

/// Median of the depths of a grid of pixels; `otherwise` where nothing is seen.
double median_depth(const View& view, double otherwise) {
  constexpr std::size_t step = 8;
  const auto width = static_cast<std::size_t>(view.lens.width);
  std::vector<double> depths;
  for (std::size_t i = 0; i < view.depth.size(); i += i % width + step < width ? step : width - i % width)
    if (!std::isnan(view.depth[i])) depths.push_back(view.depth[i]);
  if (depths.empty()) return otherwise;
  const auto median = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::nth_element(depths.begin(), median, depths.end());
  return *median;
}

PathTracer::Setup setup_of(const Sensor& sensor, const View& view) {
  PathTracer::Setup setup;
  setup.samples = sensor.settings.of<ImageSettings>().samples;
  setup.bounces = sensor.bounces.value_or(0);
  setup.blur = sensor.imager.blur;
  setup.near = sensor.near, setup.far = sensor.far;
  const auto& optics = sensor.settings.of<ImageOptics>();
  if (optics.f_number > 0.0) setup.aperture = optics.focal_length / optics.f_number;
  setup.focus = optics.focus > 0.0 ? optics.focus : median_depth(view, std::sqrt(sensor.near * sensor.far));
  setup.soft = optics.soft;
  return setup;
}

/// Radiance by pixel.
std::vector<Rgb> denoised(const PathTracer& tracer, const View& view) {
  const auto width = static_cast<std::size_t>(view.lens.width), height = static_cast<std::size_t>(view.lens.height);
  std::vector<Rgb> radiance(width * height);
  std::vector<PathTracer::Grain> grain(width * height);
  in_parallel(height, [&](std::size_t row) {
    const std::vector<Rgb> own = tracer.row(row, &grain[row * width]);
    std::copy(own.begin(), own.end(), radiance.begin() + static_cast<std::ptrdiff_t>(row * width));
  });
  denoise(view, grain, radiance);
  return radiance;
}

}  // namespace

double image_gain(const Lamps& lamps, const Sensor& sensor, const View& view) {
  const double asked = sensor.imager.reference_distance;
  const double depth = asked > 0.0 ? asked : median_depth(view, std::sqrt(sensor.near * sensor.far));
  const double white = lamps.on_plate(view.pose * Vec3(0.0, 0.0, depth), view.pose.orientation * -Vec3::UnitZ()).mean();
  return white > 0.0 ? sensor.imager.exposure / white : 0.0;
}

Measurement take_image(const Scenery& scenery, const View& view, const Sensor& sensor, const Surfaces& surfaces,
                       const Random& paths, const Random& noise, Picture& picture) {
  const auto& settings = sensor.settings.of<ImageSettings>();
  Lamps lamps(sensor.settings.of<ImageSettings>().lamps, sensor);
  const double gain = image_gain(lamps, sensor, view);
  if (gain > 0.0) lamps.add_everywhere(sensor.imager.ambient / gain);
  const auto& optics = sensor.settings.of<ImageOptics>();
  PathTracer::Setup setup = setup_of(sensor, view);
  std::optional<Bevels> bevels;
  if (optics.bevel > 0.0) setup.bevels = &bevels.emplace(scenery, optics.bevel);
  const PathTracer tracer(scenery, view.lens, view.pose, surfaces, lamps, setup, paths);
  const Imager imager(sensor.imager, sensor.noise);

  const auto width = static_cast<std::size_t>(view.lens.width), height = static_cast<std::size_t>(view.lens.height);
  const std::size_t channels = settings.colour ? 3 : 1;
  const double most = std::ldexp(1.0, settings.bits) - 1.0;
  picture.channels = static_cast<int>(channels);
  picture.bits = settings.bits;
  picture.counts.resize(width * height * channels);
  Measurement out(width * height);
  const auto expose = [&](std::size_t row, const Rgb* radiance) {
    std::vector<float> signals;
    for (std::size_t x = 0; x < width; ++x) {
      const Rgb& rgb = radiance[x];
      for (std::size_t c = 0; c < channels; ++c)
        signals.push_back(static_cast<float>(gain * (channels == 3 ? rgb[static_cast<Eigen::Index>(c)] : rgb.mean())));
    }
    Random draw = noise.of_piece(row);
    imager.expose(signals.data(), signals.size(), draw);
    for (std::size_t x = 0; x < width; ++x) {
      const std::size_t i = row * width + x;
      const bool seen = !std::isnan(view.depth[i]);
      out.depth[i] = view.depth[i];
      out.validity[i] = seen ? Validity::valid : Validity::nothing;
      for (std::size_t c = 0; c < channels; ++c) {
        const float signal = signals[x * channels + c];
        picture.counts[i * channels + c] = static_cast<std::uint16_t>(std::lround(most * signal));
        out.intensity[i] += signal / static_cast<float>(channels);
      }
      const double mean = std::min(gain * radiance[x].mean(), 1.0);
      out.snr[i] = static_cast<float>(mean / std::sqrt(imager.variance(mean) / static_cast<double>(channels)));
    }
  };
  if (settings.denoise) {
    const std::vector<Rgb> radiance = denoised(tracer, view);
    in_parallel(height, [&](std::size_t row) { expose(row, &radiance[row * width]); });
  } else {
    in_parallel(height, [&](std::size_t row) { expose(row, tracer.row(row).data()); });
  }
  return out;
}

}  // namespace bin_scenes
