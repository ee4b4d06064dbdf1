#include "sensor/models/multipath.hpp"

#include <cmath>
#include <vector>

namespace bin_scenes {

namespace {

constexpr double speed_of_light = 299792458.0;  // m/s
enum Channel { cosine, sine, channels };

/// Of the direct light of the pixels, as Path::weight; of some ten thousand of them.
double mean_light(const View& view, const Surfaces& surfaces) {
  const std::size_t step = view.depth.size() / 16384 + 1;
  double sum = 0.0, count = 0.0;
  for (std::size_t i = 0; i < view.depth.size(); i += step) {
    const SeenPoint p = seen_point(view, i);
    if (!p.hit) continue;
    Surface own;
    const Vec3 back = view.pose.position - p.position, to_light = back.normalized();
    sum += reflected(surfaces.at(p.line, p.label, p.position, own), p.normal, to_light, to_light) / back.squaredNorm();
    count += 1.0;
  }
  return count > 0.0 ? sum / count : 0.0;
}

}  // namespace

Multipath::Multipath(const Scenery& scenery, const View& view, const Surfaces& surfaces,
                     const IndirectField::Setup& setup, double modulation, const Random& rays)
    : view_(view),
      wave_(2.0 * M_PI * 1e6 * modulation / speed_of_light),
      lamp_(scenery, view.lens, view.pose, surfaces),
      field_({scenery, surfaces, lamp_}, view, setup, phasors(mean_light(view, surfaces)), rays) {}

/// Lengths are those from the light to the surface that a pixel sees.
IndirectField::Pattern Multipath::phasors(double unit) const {
  const auto add = [this](const std::vector<Path>& paths, const Vec3* steps, float* out) {
    for (const Path& path : paths) {
      const double c = path.weight * std::cos(wave_ * path.length), s = path.weight * std::sin(wave_ * path.length);
      out[cosine] += static_cast<float>(c);
      out[sine] += static_cast<float>(s);
      for (int axis = 0; axis < 2; ++axis) {
        float* const growth = out + (1 + axis) * channels;
        const double turn = wave_ * path.longer.dot(steps[axis]);
        growth[cosine] -= static_cast<float>(turn * s);
        growth[sine] += static_cast<float>(turn * c);
      }
    }
  };
  return {channels, channels, add, unit};
}

std::complex<double> Multipath::at(std::size_t pixel) const {
  float phasor[channels];
  if (!field_.at(pixel, channels, phasor)) return 0.0;
  const auto width = static_cast<std::size_t>(view_.lens.width);
  const Vec3 ray = view_.lens.ray(static_cast<double>(pixel % width), static_cast<double>(pixel / width));
  const double direct = view_.depth[pixel] * ray.norm();
  return std::complex<double>(phasor[cosine], phasor[sine]) * std::polar(1.0, -wave_ * direct);
}

}  // namespace bin_scenes
