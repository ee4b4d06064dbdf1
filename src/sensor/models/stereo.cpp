/// Renders the dot pattern into both cameras, and matches by OpenCV (`decoded`) or errs by a formula whose noise is the
/// same over a window (`analytic`).
#include "sensor/models/stereo.hpp"

#include "core/in_parallel.hpp"
#include "sensor/models/disparity_filters.hpp"
#include "sensor/models/imager.hpp"
#include "sensor/models/noise_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace bin_scenes {

namespace {

/// Bilinear between the projector's pixels.
double sampled(const std::vector<float>& pattern, const Lens& projector, double column, double row) {
  const double x = std::clamp(column, 0.0, projector.width - 1.0), y = std::clamp(row, 0.0, projector.height - 1.0);
  const int i = std::min(static_cast<int>(x), projector.width - 2),
            j = std::min(static_cast<int>(y), projector.height - 2);
  const double u = x - i, v = y - j;
  const float* const at = &pattern[static_cast<std::size_t>(j) * projector.width + i];
  const float* const below = at + projector.width;
  return (1 - v) * ((1 - u) * at[0] + u * at[1]) + v * ((1 - u) * below[0] + u * below[1]);
}

}  // namespace

namespace {

/// 1 where the projector has a dot.
std::vector<float> dots_of(int width, int height, double share, DotLayout layout) {
  std::vector<float> dots(static_cast<std::size_t>(width) * height, 0.0f);
  Random random(0, 0, Stream::sensor);  // made once in the factory: the same for every scene
  if (layout == DotLayout::random) {
    for (float& dot : dots) dot = random.uniform() < share ? 1.0f : 0.0f;
    return dots;
  }
  const auto columns = static_cast<int>(std::lround(width * std::sqrt(share)));
  const auto rows = static_cast<int>(std::lround(height * std::sqrt(share)));
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const double x = (column + random.uniform()) * width / columns, y = (row + random.uniform()) * height / rows;
      dots[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)] = 1.0f;
    }
  }
  return dots;
}

}  // namespace

std::vector<float> dot_pattern(int width, int height, double dots, DotLayout layout, double ratio) {
  std::vector<float> pattern = dots_of(width, height, dots, layout);
  // The projector's pixel, and the camera's with its lens: sharper dots would be aliased.
  const double sigma = std::hypot(0.5, 0.6 * ratio);
  const int reach = static_cast<int>(std::ceil(3.0 * sigma));
  std::vector<float> kernel(2 * reach + 1);
  float sum = 0.0f;
  for (int k = -reach; k <= reach; ++k)
    sum += kernel[k + reach] = static_cast<float>(std::exp(-0.5 * k * k / (sigma * sigma)));
  std::vector<float> rows(pattern.size());
  const auto blur = [&](const std::vector<float>& in, std::vector<float>& out, int step, int count, int other) {
    in_parallel(static_cast<std::size_t>(height), [&](std::size_t y) {
      for (int x = 0; x < width; ++x) {
        const int at = other == 0 ? x : static_cast<int>(y);
        float value = 0.0f;
        for (int k = -reach; k <= reach; ++k) {
          const int to = std::clamp(at + k, 0, count - 1) - at;
          value += kernel[k + reach] / sum * in[y * width + x + static_cast<std::ptrdiff_t>(to) * step];
        }
        out[y * width + x] = value;
      }
    });
  };
  blur(pattern, rows, 1, width, 0);
  blur(rows, pattern, width, height, 1);
  const float brightest = *std::max_element(pattern.begin(), pattern.end());
  if (brightest > 0.0f) {
    for (float& p : pattern) p /= brightest;
  }
  return pattern;
}

Stereo::Stereo(const Scenery& scenery, const View& view, const Surfaces& surfaces, const Setup& setup,
               const Random& random)
    : scenery_(scenery),
      view_(view),
      surfaces_(surfaces),
      setup_(setup),
      imager_(setup.imager, setup.noise),
      second_(view.pose * Pose{Vec3(setup.settings.baseline, 0.0, 0.0), Quat::Identity()}),
      lit_(lit(view)),
      pattern_(pattern()),
      rays_(random) {
  gain_ = gain_of(setup_.imager, lit_, view_.depth, (view_.pose.inverse() * setup_.projector_pose.position).z());
  for (const double exposure : setup.imager.exposures)
    scales_.insert(scales_.begin(), exposure / setup.imager.exposure);
  if (scales_.empty()) scales_ = {1.0};
  for (const float p : pattern_) brightness_ += (p - 1.0) / static_cast<double>(pattern_.size());
  haze_ = haze(view, rays_.of_piece(1));
}

std::vector<float> Stereo::pattern() const {
  if (!(setup_.settings.dots > 0.0)) return {};
  return dot_pattern(setup_.projector.width, setup_.projector.height, setup_.settings.dots, setup_.pipeline.layout,
                     setup_.projector.fx / view_.lens.fx);
}

/// Light via other surfaces: the mean of the pattern.
std::vector<float> Stereo::haze(const View& view, const Random& random) const {
  if (setup_.indirect.bounces == 0) return {};
  const ProjectorLamp lamp(scenery_, setup_.projector, setup_.projector_pose, surfaces_);
  const IndirectField::Pattern even{1, 0, [](const std::vector<Path>& paths, const Vec3*, float* white) {
                                      for (const Path& path : paths) *white += static_cast<float>(path.weight);
                                    }};
  const IndirectField field({scenery_, surfaces_, lamp}, view, setup_.indirect, even, random);
  std::vector<float> out(view.depth.size());
  const auto width = static_cast<std::size_t>(view.lens.width);
  in_parallel(static_cast<std::size_t>(view.lens.height), [&](std::size_t row) {
    for (std::size_t i = row * width; i < (row + 1) * width; ++i) {
      field.at(i, 1, &out[i]);
      out[i] *= static_cast<float>(gain_ * brightness_);
    }
  });
  return out;
}

std::vector<Lit> Stereo::lit(const View& view) const {
  std::vector<Lit> all(view.depth.size());
  const auto width = static_cast<std::size_t>(view.lens.width);
  in_parallel(static_cast<std::size_t>(view.lens.height), [&](std::size_t row) {
    std::vector<SeenPoint> points(width);
    for (std::size_t x = 0; x < width; ++x) points[x] = seen_point(view, row * width + x);
    light({scenery_, setup_.projector, setup_.projector_pose, surfaces_}, view.pose.position, points.data(),
          &all[row * width], width);
  });
  return all;
}

/// Signal of the surface that a pixel sees, without the sensor's light.
double Stereo::ambient(const View& view, std::size_t pixel) const {
  if (setup_.imager.ambient == 0.0) return 0.0;
  const SeenPoint p = seen_point(view, pixel);
  if (!p.hit) return 0.0;
  Surface own;
  return setup_.imager.ambient * diffuse_share(surfaces_.at(p.line, p.label, p.position, own));
}

/// Ambient light and the dots.
std::vector<float> Stereo::signals(const View& view, const std::vector<Lit>& lit,
                                   const std::vector<float>& haze) const {
  std::vector<float> out(lit.size(), 0.0f);
  const auto width = static_cast<std::size_t>(view.lens.width);
  in_parallel(static_cast<std::size_t>(view.lens.height), [&](std::size_t row) {
    for (std::size_t i = row * width; i < (row + 1) * width; ++i) {
      if (lit[i].code == Validity::nothing) continue;
      double signal = ambient(view, i);
      if (lit[i].code == Validity::valid) {
        signal +=
            white(lit[i]) * (!pattern_.empty() ? sampled(pattern_, setup_.projector, lit[i].column, lit[i].row) : 1.0);
      }
      if (!haze.empty()) signal += haze[i];
      out[i] = static_cast<float>(signal);
    }
  });
  return out;
}

/// Light of the grey image: as if the projector spread the light of its dots.
std::vector<float> Stereo::even_light() const {
  std::vector<float> out(lit_.size(), 0.0f);
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (lit_[i].code == Validity::nothing) continue;
    const double direct = lit_[i].code == Validity::valid ? brightness_ * white(lit_[i]) : 0.0;
    out[i] = static_cast<float>(direct + background(i));
  }
  return out;
}

Stereo::Signals Stereo::signals() const {
  const View second = render(scenery_, view_.lens, second_, setup_.near, setup_.far);
  return {signals(view_, lit_, haze_), signals(second, lit(second), haze(second, rays_.of_piece(2)))};
}

std::vector<std::uint8_t> Stereo::image(std::vector<float> signals, const Random& random, double scale) const {
  for (float& value : signals) value *= static_cast<float>(scale);
  std::vector<std::uint8_t> bytes(signals.size());
  const auto width = static_cast<std::size_t>(view_.lens.width);
  in_parallel(static_cast<std::size_t>(view_.lens.height), [&](std::size_t row) {
    Random draw = random.of_piece(row);
    imager_.expose(&signals[row * width], width, draw);
    for (std::size_t i = row * width; i < (row + 1) * width; ++i) {
      bytes[i] = static_cast<std::uint8_t>(std::lround(255.0f * signals[i]));
    }
  });
  return bytes;
}

Stereo::Pair Stereo::expose(const Signals& signals, const Random& random, double scale) const {
  return {image(signals.first, random.of_piece(1), scale), image(signals.second, random.of_piece(2), scale)};
}

Stereo::Pair Stereo::images(const Random& random, double scale) const {
  return expose(signals(), random, scale);
}

/// Each exposure is matched by itself; a pixel takes the longest that finds it and does not saturate there. Returns the
/// disparities; out receives signal and code.
std::vector<float> Stereo::matched(const Signals& signals, const Random& random, Measurement& out) const {
  std::vector<float> merged(view_.depth.size(), std::numeric_limits<float>::quiet_NaN());
  const int least = static_cast<int>(std::floor(of_disparity(setup_.far)));
  for (std::size_t k = 0; k < scales_.size(); ++k) {
    const Pair pair = expose(signals, k == 0 ? random : random.of_piece(2 + k), scales_[k]);
    const std::vector<float> disparity =
        match(pair, view_.lens.width, view_.lens.height, setup_.settings, setup_.pipeline, imager_, least);
    for (std::size_t i = 0; i < disparity.size(); ++i) {
      if (!std::isnan(merged[i])) continue;
      constexpr double grey = 1.0 / 255.0;  // a level, whose rounding is noise as well
      const double signal = grey * pair.first[i], z = of_disparity(disparity[i]);
      const bool last = k + 1 == scales_.size(), good = z >= setup_.near && z <= setup_.far && (last || signal < 1.0);
      if (!good && !last) continue;
      out.intensity[i] = static_cast<float>(std::min(signal / scales_[k], 1.0));
      out.snr[i] = static_cast<float>(signal / std::sqrt(imager_.variance(signal) + grey * grey / 12.0));
      out.validity[i] = good                                ? Validity::valid
                        : lit_[i].code == Validity::nothing ? Validity::nothing
                                                            : Validity::unmatched;
      if (good) merged[i] = disparity[i];
    }
  }
  return merged;
}

Measurement Stereo::decoded(const Random& random) const {
  constexpr std::uint64_t first_frame = 1000;  // pieces below are those of one frame
  const Signals light = signals();
  const int frames = setup_.noise ? setup_.pipeline.temporal.frames : 1;
  TemporalAverage average(setup_.pipeline.temporal);
  Measurement out(0);
  std::vector<float> disparities;
  for (int frame = 0; frame < frames; ++frame) {
    out = Measurement(view_.depth.size());
    disparities = matched(light, frame == 0 ? random : random.of_piece(first_frame + frame), out);
    if (setup_.gray) out.light = even_light();
    decimate(disparities, out);
    filter_one(disparities);
    if (frames > 1) average.add(disparities);
  }
  return deliver(std::move(disparities), std::move(out));
}

/// One pixel of a square is the median or mean of its disparities; it has the mean of the signals, and without any
/// disparity the code of the pixel in the middle.
void Stereo::decimate(std::vector<float>& disparities, Measurement& out) const {
  const int factor = setup_.noise ? setup_.pipeline.decimation : 1;
  if (factor == 1) return;
  const int width = view_.lens.width, columns = width / factor;
  disparities = decimated(factor, width, view_.lens.height, disparities);
  Measurement coarse(disparities.size());
  coarse.light.resize(out.light.empty() ? 0 : disparities.size());
  for (std::size_t i = 0; i < disparities.size(); ++i) {
    const std::size_t corner = i / columns * factor * width + i % columns * factor;
    for (int k = 0; k < factor * factor; ++k) {
      const std::size_t from = corner + static_cast<std::size_t>(k / factor) * width + k % factor;
      coarse.intensity[i] += out.intensity[from] / static_cast<float>(factor * factor);
      if (!out.light.empty()) coarse.light[i] += out.light[from] / static_cast<float>(factor * factor);
      coarse.snr[i] += out.snr[from] / static_cast<float>(factor * factor);
    }
    coarse.validity[i] = out.validity[corner + static_cast<std::size_t>(factor / 2) * (width + 1)];
  }
  out = std::move(coarse);
}

/// What the device does with the disparities of one image.
void Stereo::filter_one(std::vector<float>& disparities) const {
  const StereoPipeline& s = setup_.pipeline;
  if (!setup_.noise) return;
  SpatialFilter spatial = s.spatial;
  spatial.delta *= s.decimation;  // given in pixels of the delivered image
  filter_spatially(spatial, view_.lens.width / s.decimation, view_.lens.height / s.decimation, disparities);
}

/// The depths that follow.
Measurement Stereo::deliver(std::vector<float>&& disparities, Measurement&& out) const {
  const StereoPipeline& s = setup_.pipeline;
  if (setup_.noise)
    fill_holes(s.hole_filling, view_.lens.width / s.decimation, view_.lens.height / s.decimation, disparities);
  for (std::size_t i = 0; i < disparities.size(); ++i) {
    const double z = of_disparity(rounded_to_step(disparities[i], setup_.noise ? s.disparity_step : 0.0));
    if (z >= setup_.near && z <= setup_.far) {
      out.depth[i] = z;
      out.validity[i] = Validity::valid;
    } else if (out.validity[i] == Validity::valid) {
      out.validity[i] = Validity::unmatched;
    }
  }
  return std::move(out);
}

double Stereo::scale_of(double signal) const {
  for (const double scale : scales_) {
    if (!imager_.saturated(scale * signal)) return scale;
  }
  return scales_.back();
}

/// The matcher errs with the ratio of noise to texture.
double Stereo::disparity_sigma(double signal, double background) const {
  return setup_.settings.disparity_noise * std::sqrt(imager_.variance(signal + background) / imager_.variance(1.0)) /
         signal;
}

/// Light over the dots of a pixel of the first camera: noise without texture.
double Stereo::background(std::size_t pixel) const {
  return ambient(view_, pixel) + (haze_.empty() ? 0.0 : haze_[pixel]);
}

double Stereo::depth_sigma(std::size_t pixel) const {
  if (lit_[pixel].code != Validity::valid) return std::numeric_limits<double>::quiet_NaN();
  const double z = view_.depth[pixel], step = setup_.pipeline.disparity_step;
  const double signal = white(lit_[pixel]), over = background(pixel), scale = scale_of(signal + over);
  const StereoPipeline& s = setup_.pipeline;
  const double kept =
      spatially_filtered_noise(s.spatial, noise_window() / s.decimation) * temporally_filtered_noise(s.temporal);
  const double sigma = std::hypot(kept * disparity_sigma(scale * signal, scale * over), step / std::sqrt(12.0));
  return sigma * z * z / of_disparity(1.0);
}

}  // namespace bin_scenes
