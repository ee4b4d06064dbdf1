#include "sensor/models/structured_light.hpp"

#include "core/in_parallel.hpp"
#include "sensor/models/structured_light_samples.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bin_scenes {

StructuredLight::StructuredLight(const Scenery& scenery, const View& view, const Surfaces& surfaces, const Setup& setup)
    : scenery_(scenery),
      view_(view),
      surfaces_(surfaces),
      setup_(setup),
      fringes_(setup.settings, setup.projector.width),
      imager_(setup.imager, setup.noise),
      triangulation_(setup.projector, view.pose.inverse() * setup.projector_pose),
      turn_(view.pose.orientation.toRotationMatrix()),
      rays_(view.depth.size()),
      lit_(view.depth.size()) {
  const auto width = static_cast<std::size_t>(view.lens.width);
  in_parallel(static_cast<std::size_t>(view.lens.height), [&](std::size_t row) {
    std::vector<SeenPoint> points(width);
    for (std::size_t x = 0; x < width; ++x) {
      rays_[row * width + x] = view_.lens.ray(static_cast<double>(x), static_cast<double>(row));
      points[x] = seen(row * width + x);
    }
    light(scenery_, setup_.projector, setup_.projector_pose, view_.pose.position, surfaces_, points.data(),
          &lit_[row * width], width);
  });
  gain_ = gain_of(setup_.imager, lit_, view_, setup_.projector_pose.position);
}

SeenPoint StructuredLight::seen(std::size_t pixel) const {
  const double z = view_.depth[pixel];
  if (std::isnan(z)) return {};
  const auto& n = view_.normal[pixel];
  return {view_.pose * (z * rays_[pixel]), turn_ * Vec3(n[0], n[1], n[2]), view_.line[pixel], true};
}

/// Factor by which a pixel's extent on the surface weakens the fringe.
double StructuredLight::footprint(std::size_t pixel) const {
  const auto& n = view_.normal[pixel];
  const Vec3 normal(n[0], n[1], n[2]), direction = rays_[pixel];
  const double z = view_.depth[pixel], facing = normal.dot(direction);
  double factor = 1.0;
  for (const Vec3& step : {Vec3(1.0 / view_.lens.fx, 0.0, 0.0), Vec3(0.0, 1.0 / view_.lens.fy, 0.0)}) {
    const Vec3 along = z * (step - direction * (normal.dot(step) / facing));  // on the surface, a pixel further
    factor *= fringes_.seen_through(std::abs(triangulation_.columns_along(z * direction, along)));
  }
  return factor;
}

StructuredLight::Fringe StructuredLight::fringe(std::size_t pixel) const {
  const Lit& l = lit_[pixel];
  const double white = gain_ * l.reflected / (l.distance * l.distance);
  const double ambient = setup_.imager.ambient * diffuse_share(surfaces_.of(view_.line[pixel]));
  return {ambient + white * fringes_.mean(), white * fringes_.amplitude() * footprint(pixel)};
}

double StructuredLight::depth_sigma(std::size_t pixel) const {
  if (lit_[pixel].code != Validity::valid) return std::numeric_limits<double>::quiet_NaN();
  const Fringe f = fringe(pixel);
  return triangulation_.depth_per_column(rays_[pixel], view_.depth[pixel]) *
         fringes_.column_sigma(std::sqrt(imager_.variance(f.mean)), f.amplitude);
}

/// Whether a neighbour lies off the plane of this pixel's face by more than an edge.
bool StructuredLight::near_edge(std::size_t pixel) const {
  const int width = view_.lens.width, x = static_cast<int>(pixel) % width, y = static_cast<int>(pixel) / width;
  const auto& n = view_.normal[pixel];
  const Vec3 normal(n[0], n[1], n[2]), direction = rays_[pixel];
  const double plane = view_.depth[pixel] * normal.dot(direction);
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const int u = x + dx, v = y + dy;
      if (u < 0 || v < 0 || u >= width || v >= view_.lens.height) continue;
      const double there = view_.depth[static_cast<std::size_t>(v) * width + u];
      const Vec3 next = direction + Vec3(dx / view_.lens.fx, dy / view_.lens.fy, 0.0);
      if (!(std::abs(there - plane / normal.dot(next)) < setup_.settings.edge_step)) return true;
    }
  }
  return false;
}

void StructuredLight::sample(const std::vector<std::size_t>& pixels, Samples& out) const {
  constexpr int n = Samples::per_pixel;
  out.rays.resize(n * pixels.size());
  out.hits.resize(out.rays.size());
  out.points.resize(out.rays.size());
  out.lit.resize(out.rays.size());
  out.mixed.assign(pixels.size(), 0);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const Vec3 middle = rays_[pixels[i]];
    for (int k = 0; k < n; ++k) {
      const Vec3 offset((k & 1 ? 0.25 : -0.25) / view_.lens.fx, (k & 2 ? 0.25 : -0.25) / view_.lens.fy, 0.0);
      out.rays[n * i + k] = {view_.pose.position, turn_ * (middle + offset), setup_.near, setup_.far};
    }
  }
  scenery_.first_hits(out.rays.data(), out.hits.data(), out.rays.size());
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const SeenPoint middle = seen(pixels[i]);
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

/// Column that the fringes of a pixel's four samples add up to, as a phase near that of the brightest.
double StructuredLight::mixed_column(const Lit* lit) const {
  const auto signal = [](const Lit& l) {
    return l.code == Validity::valid ? l.reflected / (l.distance * l.distance) : 0.0;
  };
  const Lit* const brightest = std::max_element(lit, lit + Samples::per_pixel,
                                                [&](const Lit& a, const Lit& b) { return signal(a) < signal(b); });
  double sine = 0.0, cosine = 0.0;
  const double turn = 2.0 * M_PI / setup_.settings.period;
  for (int k = 0; k < Samples::per_pixel; ++k) {
    sine += signal(lit[k]) * std::sin(turn * (lit[k].column - brightest->column));
    cosine += signal(lit[k]) * std::cos(turn * (lit[k].column - brightest->column));
  }
  return brightest->column + std::atan2(sine, cosine) / turn;
}

void StructuredLight::deliver(Measurement& out, std::size_t pixel, double column) const {
  const double z = triangulation_.depth(rays_[pixel], column);
  const bool good = z >= setup_.near && z <= setup_.far;
  out.validity[pixel] = good ? Validity::valid : Validity::decoding;
  if (good) out.depth[pixel] = z;
}

Measurement StructuredLight::analytic(const Random& random) const {
  Measurement out(view_.depth.size());
  const auto width = static_cast<std::size_t>(view_.lens.width);
  const bool keep = setup_.settings.mixed == MixedPixels::keep;
  in_parallel(static_cast<std::size_t>(view_.lens.height), [&](std::size_t row) {
    std::vector<std::size_t> edges;
    for (std::size_t i = row * width; i < (row + 1) * width; ++i) {
      if (lit_[i].code == Validity::valid && near_edge(i)) edges.push_back(i);
    }
    Samples samples;
    sample(edges, samples);

    Random draw = random.of_piece(row);
    std::size_t next = 0;  // of the edges
    for (std::size_t i = row * width; i < (row + 1) * width; ++i) {
      const std::size_t edge = next < edges.size() && edges[next] == i ? next++ : edges.size();
      out.validity[i] = lit_[i].code;
      if (lit_[i].code != Validity::valid) continue;
      double of_phase = 0.0, of_amplitude = 0.0;
      if (setup_.noise) draw.normals(of_phase, of_amplitude);
      const Fringe f = fringe(i);
      const double sigma = std::sqrt(imager_.variance(f.mean));
      out.intensity[i] = static_cast<float>(std::min(f.mean, 1.0));
      const bool mixed = edge < edges.size() && samples.mixed[edge];
      if (mixed && !keep) {
        out.validity[i] = Validity::mixed;
      } else if (imager_.saturated(f.mean + f.amplitude * fringes_.brightest(lit_[i].column))) {
        out.validity[i] = Validity::saturated;
      } else if (f.amplitude + fringes_.amplitude_sigma(sigma) * of_amplitude < setup_.settings.min_modulation) {
        out.validity[i] = Validity::dark;
      } else {
        const double column = mixed ? mixed_column(&samples.lit[Samples::per_pixel * edge]) : lit_[i].column;
        deliver(out, i, column + fringes_.column_sigma(sigma, f.amplitude) * of_phase);
      }
    }
  });
  return out;
}

}  // namespace bin_scenes
