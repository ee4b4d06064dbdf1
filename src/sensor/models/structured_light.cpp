#include "sensor/models/structured_light.hpp"

#include "core/in_parallel.hpp"
#include "sensor/models/structured_light_samples.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace bin_scenes {

namespace {
constexpr double least_step = 2e-6;  // m; below it two faces are one, whatever the noise
}

StructuredLight::StructuredLight(const Scenery& scenery, const View& view, const Surfaces& surfaces, const Setup& setup)
    : scenery_(scenery),
      view_(view),
      surfaces_(surfaces),
      setup_(setup),
      fringes_(setup.settings, setup.projector.width),
      imager_(setup.imager, setup.noise),
      triangulation_(setup.projector, view.pose.inverse() * setup.projector_pose),
      turn_(view.pose.orientation.toRotationMatrix()),
      gain_(gain()) {}

std::vector<StructuredLight::Pixel> StructuredLight::lit(std::vector<std::size_t> indices) const {
  const auto width = static_cast<std::size_t>(view_.lens.width);
  std::vector<Pixel> pixels;
  std::vector<SeenPoint> points;
  pixels.reserve(indices.size());
  points.reserve(indices.size());
  for (const std::size_t i : indices) {
    pixels.push_back({i, view_.lens.ray(static_cast<double>(i % width), static_cast<double>(i / width)), {}});
    points.push_back(seen(i, pixels.back().ray));
  }
  std::vector<Lit> all(pixels.size());
  light(scenery_, setup_.projector, setup_.projector_pose, view_.pose.position, surfaces_, points.data(), all.data(),
        all.size());
  for (std::size_t i = 0; i < all.size(); ++i) pixels[i].lit = all[i];
  return pixels;
}

std::vector<StructuredLight::Pixel> StructuredLight::lit_row(std::size_t row) const {
  std::vector<std::size_t> indices(static_cast<std::size_t>(view_.lens.width));
  std::iota(indices.begin(), indices.end(), row * indices.size());
  return lit(std::move(indices));
}

/// The automatic exposure looks at a grid of pixels: some ten thousand tell the median distance as well as all do.
double StructuredLight::gain() const {
  constexpr double enough = 16384;
  const auto width = static_cast<std::size_t>(view_.lens.width), height = static_cast<std::size_t>(view_.lens.height);
  const auto step = static_cast<std::size_t>(std::max(1.0, std::sqrt(static_cast<double>(width * height) / enough)));
  const std::size_t columns = (width - step / 2 + step - 1) / step, rows = (height - step / 2 + step - 1) / step;
  std::vector<Lit> all(columns * rows);
  std::vector<double> depths(all.size());
  in_parallel(rows, [&](std::size_t row) {
    std::vector<std::size_t> indices;
    for (std::size_t x = step / 2; x < width; x += step) indices.push_back((step / 2 + row * step) * width + x);
    std::size_t at = row * columns;
    for (const Pixel& pixel : lit(std::move(indices))) {
      all[at] = pixel.lit;
      depths[at++] = view_.depth[pixel.index];
    }
  });
  return gain_of(setup_.imager, all, depths, (view_.pose.inverse() * setup_.projector_pose.position).z());
}

SeenPoint StructuredLight::seen(std::size_t index, const Vec3& ray) const {
  const double z = view_.depth[index];
  if (std::isnan(z)) return {};
  const auto& n = view_.normal[index];
  return {view_.pose * (z * ray), turn_ * Vec3(n[0], n[1], n[2]), view_.line[index], true};
}

/// Factor by which a pixel's extent on the surface weakens the fringe.
double StructuredLight::footprint(const Pixel& pixel) const {
  const auto& n = view_.normal[pixel.index];
  const Vec3 normal(n[0], n[1], n[2]), direction = pixel.ray;
  const double z = view_.depth[pixel.index], facing = normal.dot(direction);
  double factor = 1.0;
  for (const Vec3& step : {Vec3(1.0 / view_.lens.fx, 0.0, 0.0), Vec3(0.0, 1.0 / view_.lens.fy, 0.0)}) {
    const Vec3 along = z * (step - direction * (normal.dot(step) / facing));  // on the surface, a pixel further
    factor *= fringes_.seen_through(std::abs(triangulation_.columns_along(z * direction, along)));
  }
  return factor;
}

double StructuredLight::ambient(const Pixel& pixel) const {
  return setup_.imager.ambient * diffuse_share(surfaces_.of(view_.line[pixel.index]));
}

StructuredLight::Fringe StructuredLight::fringe(const Pixel& pixel) const {
  const double white = gain_ * pixel.lit.reflected / (pixel.lit.distance * pixel.lit.distance);
  return {ambient(pixel) + white * fringes_.mean(), white * fringes_.amplitude() * footprint(pixel)};
}

double StructuredLight::depth_sigma(std::size_t index) const {
  const Pixel pixel = lit({index}).front();
  if (pixel.lit.code != Validity::valid) return std::numeric_limits<double>::quiet_NaN();
  return depth_sigma(pixel, fringe(pixel));
}

double StructuredLight::depth_sigma(const Pixel& pixel, const Fringe& f) const {
  return triangulation_.depth_per_column(pixel.ray, view_.depth[pixel.index]) *
         fringes_.column_sigma(std::sqrt(imager_.variance(f.mean)), f.amplitude);
}

/// Whether the faces beside a pixel's own one matter. Its samples lie a quarter of a pixel from its centre and see
/// about a quarter of the step to a neighbour; noise of twice that hides it.
bool StructuredLight::is_uneven(const Pixel& pixel, const Fringe& fringe) const {
  const double step = step_beside(pixel);
  return step >= setup_.settings.edge_step || (step > least_step && step > 2.0 * depth_sigma(pixel, fringe));
}

/// By how much a neighbour lies off the plane of this pixel's face (m); infinite where a neighbour sees nothing.
double StructuredLight::step_beside(const Pixel& pixel) const {
  const int width = view_.lens.width, x = static_cast<int>(pixel.index) % width,
            y = static_cast<int>(pixel.index) / width;
  const auto& n = view_.normal[pixel.index];
  const Vec3 normal(n[0], n[1], n[2]), direction = pixel.ray;
  const double plane = view_.depth[pixel.index] * normal.dot(direction);
  double largest = 0.0;
  for (int v = std::max(0, y - 1); v <= std::min(y + 1, view_.lens.height - 1); ++v) {
    for (int u = std::max(0, x - 1); u <= std::min(x + 1, width - 1); ++u) {
      const double there = view_.depth[static_cast<std::size_t>(v) * width + u];
      if (std::isnan(there)) return std::numeric_limits<double>::infinity();
      const Vec3 next = direction + Vec3((u - x) / view_.lens.fx, (v - y) / view_.lens.fy, 0.0);
      largest = std::max(largest, std::abs(there - plane / normal.dot(next)));
    }
  }
  return largest;
}

void StructuredLight::sample(const std::vector<Pixel>& pixels, Samples& out) const {
  constexpr int n = Samples::per_pixel;
  out.rays.resize(n * pixels.size());
  out.hits.resize(out.rays.size());
  out.points.resize(out.rays.size());
  out.lit.resize(out.rays.size());
  out.mixed.assign(pixels.size(), 0);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const Vec3 middle = pixels[i].ray;
    for (int k = 0; k < n; ++k) {
      const Vec3 offset((k & 1 ? 0.25 : -0.25) / view_.lens.fx, (k & 2 ? 0.25 : -0.25) / view_.lens.fy, 0.0);
      out.rays[n * i + k] = {view_.pose.position, turn_ * (middle + offset), setup_.near, setup_.far};
    }
  }
  scenery_.first_hits(out.rays.data(), out.hits.data(), out.rays.size());
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const SeenPoint middle = seen(pixels[i].index, pixels[i].ray);
    const double plane = middle.normal.dot(middle.position - view_.pose.position);
    for (int k = 0; k < n; ++k) {
      const Ray& ray = out.rays[n * i + k];
      const Hit& hit = out.hits[n * i + k];
      const bool there = !std::isnan(hit.distance);
      out.points[n * i + k] = {ray.origin + hit.distance * ray.direction, hit.normal, hit.line, there};
      const double expected = plane / middle.normal.dot(ray.direction);
      if (!(std::abs(hit.distance - expected) < setup_.settings.edge_step)) out.mixed[i] = 1;
    }
  }
  light(scenery_, setup_.projector, setup_.projector_pose, view_.pose.position, surfaces_, out.points.data(),
        out.lit.data(), out.points.size());
}

/// What the fringes of a pixel's four samples add up to. The column is the one that their common phase names nearest to
/// the brightest of them.
StructuredLight::Reading StructuredLight::summed(const Pixel& pixel, const Lit* samples) const {
  const auto signal = [](const Lit& l) {
    return l.code == Validity::valid ? l.reflected / (l.distance * l.distance) : 0.0;
  };
  const Lit* const brightest = std::max_element(samples, samples + Samples::per_pixel,
                                                [&](const Lit& a, const Lit& b) { return signal(a) < signal(b); });
  double sine = 0.0, cosine = 0.0, white = 0.0;
  const double turn = 2.0 * M_PI / setup_.settings.period;
  for (int k = 0; k < Samples::per_pixel; ++k) {
    const double s = gain_ * signal(samples[k]) / Samples::per_pixel;
    sine += s * std::sin(turn * (samples[k].column - brightest->column));
    cosine += s * std::cos(turn * (samples[k].column - brightest->column));
    white += s;
  }
  return {brightest->column + std::atan2(sine, cosine) / turn,
          {ambient(pixel) + white * fringes_.mean(), fringes_.amplitude() * std::hypot(sine, cosine)}};
}

void StructuredLight::deliver(Measurement& out, const Pixel& pixel, double column) const {
  const double z = triangulation_.depth(pixel.ray, column);
  const bool good = z >= setup_.near && z <= setup_.far;
  out.validity[pixel.index] = good ? Validity::valid : Validity::decoding;
  if (good) out.depth[pixel.index] = z;
}

Measurement StructuredLight::analytic(const Random& random) const {
  Measurement out(view_.depth.size());
  const bool keep = setup_.settings.mixed == MixedPixels::keep;
  in_parallel(static_cast<std::size_t>(view_.lens.height), [&](std::size_t row) {
    const std::vector<Pixel> pixels = lit_row(row);
    const auto lit = [&](std::size_t x) { return x >= pixels.size() || pixels[x].lit.code == Validity::valid; };
    // Where a pixel sees more than one face, or half a shadow, its samples tell what comes of it.
    std::vector<Pixel> uneven;
    std::vector<Fringe> fringes(pixels.size());
    for (std::size_t x = 0; x < pixels.size(); ++x) {
      if (!lit(x)) continue;
      fringes[x] = fringe(pixels[x]);
      if (!lit(x - 1) || !lit(x + 1) || is_uneven(pixels[x], fringes[x])) uneven.push_back(pixels[x]);
    }
    Samples samples;
    sample(uneven, samples);

    Random draw = random.of_piece(row);
    std::size_t next = 0;  // of the uneven ones
    for (std::size_t x = 0; x < pixels.size(); ++x) {
      const Pixel& pixel = pixels[x];
      const std::size_t i = pixel.index;
      out.validity[i] = pixel.lit.code;
      if (pixel.lit.code != Validity::valid) continue;
      const bool sampled = next < uneven.size() && uneven[next].index == i;
      const bool mixed = sampled && samples.mixed[next];
      const Reading reading =
          sampled ? summed(pixel, &samples.lit[Samples::per_pixel * next]) : Reading{pixel.lit.column, fringes[x]};
      next += sampled;
      double of_phase = 0.0, of_amplitude = 0.0;
      if (setup_.noise) draw.normals(of_phase, of_amplitude);
      const Fringe& f = reading.fringe;
      const double sigma = std::sqrt(imager_.variance(f.mean));
      out.intensity[i] = static_cast<float>(std::min(f.mean, 1.0));
      if (mixed && !keep) {
        out.validity[i] = Validity::mixed;
      } else if (imager_.saturated(f.mean + f.amplitude * fringes_.brightest(reading.column))) {
        out.validity[i] = Validity::saturated;
      } else if (f.amplitude + fringes_.amplitude_sigma(sigma) * of_amplitude < setup_.settings.min_modulation) {
        out.validity[i] = Validity::dark;
      } else {
        deliver(out, pixel, reading.column + fringes_.column_sigma(sigma, f.amplitude) * of_phase);
      }
    }
  });
  return out;
}

}  // namespace bin_scenes
