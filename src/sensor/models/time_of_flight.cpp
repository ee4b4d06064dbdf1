/// Casts four rays a pixel, more where depth jumps, and weighs their depths by returned light, to which light via
/// other surfaces is added. Noise is drawn along and across the ray; the grey image has the light of unmoved rays.
#include "sensor/models/time_of_flight.hpp"

#include "core/in_parallel.hpp"
#include "sensor/models/cells.hpp"
#include "sensor/models/multipath.hpp"
#include "sensor/models/time_of_flight_noise.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace bin_scenes {

namespace {

struct Returned {
  double depth = 0.0, signal = 0.0;  ///< of the light that comes back: weighted mean, mean over the cells
  bool mixed = false;
};

/// Pixels of a row and the rays through their cells.
class Row {
 public:
  Row(const Scenery& scenery, const View& view, const Surfaces& surfaces, std::size_t row, double near, double far,
      double edge_step)
      : scenery_(scenery),
        view_(view),
        surfaces_(surfaces),
        row_(row),
        near_(near),
        far_(far),
        edge_step_(edge_step),
        turn_(view.pose.orientation.toRotationMatrix()) {}

  Vec3 center(std::size_t x) const { return view_.lens.ray(static_cast<double>(x), static_cast<double>(row_)); }

  /// @param jitter  of each pixel's rays (pixel)
  std::vector<Returned> returned(const std::vector<Eigen::Vector2d>& jitter) const {
    std::vector<Cell> corners, others;
    for (std::size_t x = 0; x < jitter.size(); ++x) {
      for (const int k : cells::corners) corners.push_back({x, k});
    }
    std::vector<Ray> rays = rays_of(corners, jitter), more_rays;
    std::vector<Hit> hits(rays.size());
    scenery_.first_hits(rays.data(), hits.data(), rays.size());
    std::vector<char> crossed(jitter.size(), 0);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      if (!on_face(corners[i].pixel, rays[i], hits[i])) crossed[corners[i].pixel] = 1;
    }
    for (std::size_t x = 0; x < jitter.size(); ++x) {
      for (int k = 0; crossed[x] && k < cells::per_pixel; ++k) {
        if (!cells::is_corner(k)) others.push_back({x, k});
      }
    }
    more_rays = rays_of(others, jitter);
    std::vector<Hit> more_hits(more_rays.size());
    scenery_.first_hits(more_rays.data(), more_hits.data(), more_rays.size());

    std::vector<Returned> out(jitter.size());
    std::size_t next = 0;
    for (std::size_t x = 0; x < jitter.size(); ++x) {
      Sum sum;
      for (std::size_t k = 4 * x; k < 4 * x + 4; ++k) add(x, rays[k], hits[k], sum);
      for (; next < others.size() && others[next].pixel == x; ++next) add(x, more_rays[next], more_hits[next], sum);
      const std::size_t i = row_ * jitter.size() + x;
      out[x].depth = sum.signal > 0.0 ? sum.depth / sum.signal : view_.depth[i];
      out[x].signal = sum.signal / (crossed[x] ? cells::per_pixel : 4);
      out[x].mixed = sum.farthest - sum.nearest > edge_step_;
    }
    return out;
  }

 private:
  struct Cell {
    std::size_t pixel;
    int number;
  };
  struct Sum {
    double depth = 0.0, signal = 0.0, nearest = std::numeric_limits<double>::infinity(), farthest = 0.0;
  };

  std::vector<Ray> rays_of(const std::vector<Cell>& asked, const std::vector<Eigen::Vector2d>& jitter) const {
    std::vector<Ray> rays;
    rays.reserve(asked.size());
    for (const Cell& cell : asked) {
      const Eigen::Vector2d& j = jitter[cell.pixel];
      const Vec3 offset((j.x() + cells::across(cell.number)) / view_.lens.fx,
                        (j.y() + cells::down(cell.number)) / view_.lens.fy, 0.0);
      rays.push_back({view_.pose.position, turn_ * (center(cell.pixel) + offset), near_, far_});
    }
    return rays;
  }
  /// Whether a ray meets the face that its pixel's centre sees.
  bool on_face(std::size_t x, const Ray& ray, const Hit& hit) const {
    const std::size_t i = row_ * static_cast<std::size_t>(view_.lens.width) + x;
    const auto& n = view_.normal[i];
    const Vec3 normal = turn_ * Vec3(n[0], n[1], n[2]);
    const double plane = view_.depth[i] * normal.dot(turn_ * center(x));
    return std::abs(hit.distance - plane / normal.dot(ray.direction)) < edge_step_;
  }
  /// What lies on the face that the centre sees has the centre's depth: jitter of the ray moves edges, not planes.
  void add(std::size_t x, const Ray& ray, const Hit& hit, Sum& sum) const {
    if (std::isnan(hit.distance)) return;
    const std::size_t i = row_ * static_cast<std::size_t>(view_.lens.width) + x;
    const double depth = on_face(x, ray, hit) ? view_.depth[i] : hit.distance;
    const Vec3 back = -ray.direction.normalized();
    Surface own;
    const Surface& surface = surfaces_.at(hit.line, hit.label, ray.origin + hit.distance * ray.direction, own);
    const double signal = reflected(surface, hit.normal, back, back) / (depth * depth);
    sum.depth += signal * depth;
    sum.signal += signal;
    sum.nearest = std::min(sum.nearest, depth);
    sum.farthest = std::max(sum.farthest, depth);
  }

  const Scenery& scenery_;
  const View& view_;
  const Surfaces& surfaces_;
  std::size_t row_;
  double near_, far_, edge_step_;
  Mat3 turn_;
};

/// Light via other surfaces, where a pixel's centre sees: the camera measures the phase of the sum.
/// @param ray  through the centre, z = 1
void add(const Multipath& multipath, std::size_t pixel, const Vec3& ray, Returned& light) {
  const std::complex<double> late = multipath.at(pixel);
  if (late == 0.0) return;
  const double slant2 = ray.squaredNorm();  // signals go with depth, not with distance
  const std::complex<double> sum = light.signal + slant2 * late;
  light.signal = std::abs(sum);
  light.depth += multipath.range(std::arg(sum)) / std::sqrt(slant2);
}

}  // namespace

Measurement time_of_flight(const Scenery& scenery, const View& view, const Surfaces& surfaces,
                           const TimeOfFlightSetup& setup, const Random& random, const Random& rays) {
  const TimeOfFlightSettings& s = setup.settings;
  std::optional<Multipath> multipath;
  if (setup.indirect.bounces > 0) multipath.emplace(scenery, view, surfaces, setup.indirect, s.modulation, rays);
  Measurement out(view.depth.size());
  if (setup.gray) out.light.resize(view.depth.size());
  const auto width = static_cast<std::size_t>(view.lens.width);
  in_parallel(static_cast<std::size_t>(view.lens.height), [&](std::size_t y) {
    Random draw = random.of_piece(y);
    const Row row(scenery, view, surfaces, y, setup.near, setup.far, s.edge_step);
    std::vector<double> incidence(width, 0.0);
    std::vector<Eigen::Vector2d> jitter(width, Eigen::Vector2d::Zero());
    for (std::size_t x = 0; x < width; ++x) {
      const std::size_t i = y * width + x;
      if (!std::isnan(view.depth[i])) {
        const auto& n = view.normal[i];
        incidence[x] = std::acos(std::clamp(-Vec3(n[0], n[1], n[2]).dot(row.center(x).normalized()), 0.0, 1.0));
      }
      if (!setup.noise) continue;
      draw.normals(jitter[x].x(), jitter[x].y());
      jitter[x] *= lateral_sigma(s, incidence[x]);
    }
    std::vector<Returned> light = row.returned(jitter), still;
    if (setup.gray && !setup.noise) still = light;
    if (setup.gray && setup.noise) still = row.returned(std::vector<Eigen::Vector2d>(width, Eigen::Vector2d::Zero()));
    for (std::size_t x = 0; x < width; ++x) {
      const std::size_t i = y * width + x;
      double axial = 0.0, unused = 0.0;
      if (setup.noise) draw.normals(axial, unused);
      if (std::isnan(view.depth[i])) continue;
      if (multipath) add(*multipath, i, row.center(x), light[x]);
      if (multipath && setup.gray) add(*multipath, i, row.center(x), still[x]);
      if (setup.gray) out.light[i] = static_cast<float>(still[x].signal);
      out.intensity[i] = static_cast<float>(std::min(light[x].signal, 1.0));
      if (light[x].signal < s.min_signal) {
        out.validity[i] = Validity::dark;
      } else if (light[x].mixed && s.mixed == MixedPixels::remove) {
        out.validity[i] = Validity::mixed;
      } else {
        // Cosine and distance are in the formula already; what is left of the signal is the surface's.
        const double facing =
            light[x].signal * light[x].depth * light[x].depth / std::max(std::cos(incidence[x]), 1e-3);
        const double sigma = axial_sigma(s, light[x].depth, incidence[x], facing);
        const double z = light[x].depth + (setup.noise ? axial * sigma : 0.0);
        out.snr[i] = static_cast<float>(light[x].depth / sigma);
        const bool in_range = z >= setup.near && z <= setup.far;
        out.validity[i] = in_range ? Validity::valid : Validity::nothing;
        if (in_range) out.depth[i] = z;
      }
    }
  });
  return out;
}

}  // namespace bin_scenes
