#include "sensor/models/time_of_flight.hpp"

#include "core/in_parallel.hpp"
#include "sensor/models/time_of_flight_noise.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes {

namespace {

constexpr int samples = 4;  // rays through the middles of a pixel's quarters

struct Returned {
  double depth = 0.0, signal = 0.0;  ///< of the light that comes back: weighted mean, sum of weights
  bool mixed = false;
};

/// Light of the samples of one pixel. What lies on the face that its centre sees has the centre's depth: jitter of the
/// ray moves edges, not planes.
Returned returned(const View& view, std::size_t pixel, const Surfaces& surfaces, const Ray* rays, const Hit* hits,
                  double edge_step) {
  const auto& n = view.normal[pixel];
  const Vec3 normal = view.pose.orientation * Vec3(n[0], n[1], n[2]);
  const auto width = static_cast<std::size_t>(view.lens.width);
  const Vec3 middle =
      view.pose.orientation * view.lens.ray(static_cast<double>(pixel % width), static_cast<double>(pixel / width));
  const double plane = view.depth[pixel] * normal.dot(middle);
  Returned sum;
  double nearest = std::numeric_limits<double>::infinity(), farthest = 0.0;
  for (int k = 0; k < samples; ++k) {
    if (std::isnan(hits[k].distance)) continue;
    const bool same = std::abs(hits[k].distance - plane / normal.dot(rays[k].direction)) < edge_step;
    const double depth = same ? view.depth[pixel] : hits[k].distance;
    const Vec3 back = -rays[k].direction.normalized();
    const double signal = reflected(surfaces.of(hits[k].line), hits[k].normal, back, back) / (depth * depth) / samples;
    sum.depth += signal * depth;
    sum.signal += signal;
    nearest = std::min(nearest, depth);
    farthest = std::max(farthest, depth);
  }
  if (sum.signal > 0.0) sum.depth /= sum.signal;
  sum.mixed = farthest - nearest > edge_step;
  return sum;
}

}  // namespace

Measurement time_of_flight(const Scenery& scenery, const View& view, const Surfaces& surfaces,
                           const TimeOfFlightSettings& s, bool noise, double near, double far, const Random& random) {
  Measurement out(view.depth.size());
  const auto width = static_cast<std::size_t>(view.lens.width);
  const Mat3 turn = view.pose.orientation.toRotationMatrix();
  in_parallel(static_cast<std::size_t>(view.lens.height), [&](std::size_t row) {
    Random draw = random.of_piece(row);
    std::vector<Ray> rays(samples * width);
    std::vector<Hit> hits(rays.size());
    std::vector<double> incidence(width, 0.0);
    for (std::size_t x = 0; x < width; ++x) {
      const std::size_t i = row * width + x;
      const Vec3 middle = view.lens.ray(static_cast<double>(x), static_cast<double>(row));
      if (!std::isnan(view.depth[i])) {
        const auto& n = view.normal[i];
        incidence[x] = std::acos(std::clamp(-Vec3(n[0], n[1], n[2]).dot(middle.normalized()), 0.0, 1.0));
      }
      double u = 0.0, v = 0.0;
      if (noise) {
        draw.normals(u, v);
        const double sigma = lateral_sigma(s, incidence[x]);
        u *= sigma;
        v *= sigma;
      }
      for (int k = 0; k < samples; ++k) {
        const Vec3 offset((u + (k & 1 ? 0.25 : -0.25)) / view.lens.fx, (v + (k & 2 ? 0.25 : -0.25)) / view.lens.fy,
                          0.0);
        rays[samples * x + k] = {view.pose.position, turn * (middle + offset), near, far};
      }
    }
    scenery.first_hits(rays.data(), hits.data(), rays.size());
    for (std::size_t x = 0; x < width; ++x) {
      const std::size_t i = row * width + x;
      double axial = 0.0, unused = 0.0;
      if (noise) draw.normals(axial, unused);
      if (std::isnan(view.depth[i])) continue;
      const Returned light = returned(view, i, surfaces, &rays[samples * x], &hits[samples * x], s.edge_step);
      out.intensity[i] = static_cast<float>(std::min(light.signal, 1.0));
      if (light.signal < s.min_signal) {
        out.validity[i] = Validity::dark;
      } else if (light.mixed && s.mixed == MixedPixels::remove) {
        out.validity[i] = Validity::mixed;
      } else {
        // Cosine and distance are in the formula already; what is left of the signal is the surface's.
        const double facing = light.signal * light.depth * light.depth / std::max(std::cos(incidence[x]), 1e-3);
        const double z = light.depth + axial * (noise ? axial_sigma(s, light.depth, incidence[x], facing) : 0.0);
        const bool in_range = z >= near && z <= far;
        out.validity[i] = in_range ? Validity::valid : Validity::nothing;
        if (in_range) out.depth[i] = z;
      }
    }
  });
  return out;
}

}  // namespace bin_scenes
