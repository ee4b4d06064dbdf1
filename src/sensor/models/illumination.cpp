#include "sensor/models/illumination.hpp"

#include "sensor/models/facets.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace bin_scenes {

SentBack sent_back(const Surface& surface, const Vec3& normal, const Vec3& to_light, const Vec3& to_eye) {
  const double in = normal.dot(to_light), out = normal.dot(to_eye);
  if (!(in > 0.0 && out > 0.0)) return {};
  const double matte = diffuse_share(surface) * in;
  if (surface.gloss <= 0.0) return {matte, 0.0};
  const double alpha = std::max(surface.roughness * surface.roughness, 1e-3);
  const Vec3 between = (to_light + to_eye).normalized();
  const double half = normal.dot(between);
  double once = 1.0, often = 1.0;
  if (surface.metal()) {
    once = fresnel(std::min(to_light.dot(between), 1.0), surface.refraction, surface.extinction);
    often = mean_fresnel(surface.refraction, surface.extinction);
  }
  const double share = surface.albedo * surface.gloss;
  if (const auto frame = frame_along(surface, normal)) {
    const Mat3 local = frame->transpose();
    return {matte, share * brushed_lobe(surface, local * to_light, local * to_eye, once, often)};
  }
  return {matte, share * facet_lobe(alpha, std::min(in, 1.0), std::min(out, 1.0), half, once, often)};
}

double reflected(const Surface& surface, const Vec3& normal, const Vec3& to_light, const Vec3& to_eye) {
  const SentBack all = sent_back(surface, normal, to_light, to_eye);
  return all.matte + all.mirrored;
}

SeenPoint seen_point(const View& view, std::size_t pixel) {
  const double z = view.depth[pixel];
  if (std::isnan(z)) return {};
  const auto width = static_cast<std::size_t>(view.lens.width);
  const Vec3 ray = view.lens.ray(static_cast<double>(pixel % width), static_cast<double>(pixel / width));
  const auto& n = view.normal[pixel];
  return {view.pose * (z * ray), view.pose.orientation * Vec3(n[0], n[1], n[2]), view.line[pixel], true,
          view.label[pixel]};
}

Ray ray_between(const Vec3& surface, const Vec3& normal, const Vec3& point) {
  constexpr double gap = 1e-5;  // m
  const Vec3 start = surface + gap * normal;
  return {start, point - start, 0.0, 1.0};
}

namespace {

/// @param eye_of  by number of the point
template <class EyeOf>
void light_seen_from(const Scenery& scenery, const Lens& projector, const Pose& pose, const EyeOf& eye_of,
                     const Surfaces& surfaces, const SeenPoint* points, Lit* lit, std::size_t count,
                     Scenery::Rays kind) {
  const Mat3 turn = pose.orientation.toRotationMatrix().transpose();
  std::vector<Ray> rays;
  std::vector<std::size_t> asked;
  rays.reserve(count);
  asked.reserve(count);
  const bool distorts = projector.distorts();
  const auto project = [&](const Vec3& point) -> std::optional<Eigen::Vector2d> {
    if (distorts || !(point.z() > 0.0)) return projector.project(point);
    const double x = point.x() / point.z(), y = point.y() / point.z();
    return Eigen::Vector2d(projector.fx * x + projector.skew * y + projector.cx, projector.fy * y + projector.cy);
  };
  const auto shine = [&](std::size_t i) {
    const SeenPoint& p = points[i];
    Surface own;
    lit[i].code = Validity::valid;
    lit[i].reflected = reflected(surfaces.at(p.line, p.label, p.position, own), p.normal,
                                 (pose.position - p.position) / lit[i].distance, (eye_of(i) - p.position).normalized());
  };
  for (std::size_t i = 0; i < count; ++i) {
    const SeenPoint& p = points[i];
    lit[i] = {};
    if (!p.hit) continue;
    lit[i].code = Validity::outside;
    const auto pixel = project(turn * (p.position - pose.position));
    if (!pixel) continue;
    lit[i].column = pixel->x();
    lit[i].row = pixel->y();
    lit[i].distance = (pose.position - p.position).norm();
    if (!projector.inside(*pixel)) continue;
    lit[i].code = Validity::shadow;
    if (!(p.normal.dot(pose.position - p.position) > 0.0)) continue;  // the camera sees the other side
    if (p.clear) {
      shine(i);
      continue;
    }
    rays.push_back(ray_between(p.position, p.normal, pose.position));
    asked.push_back(i);
  }
  std::vector<std::uint8_t> blocked(rays.size());
  scenery.blocked(rays.data(), blocked.data(), rays.size(), kind);
  for (std::size_t k = 0; k < asked.size(); ++k) {
    if (!blocked[k]) shine(asked[k]);
  }
}

}  // namespace

void light(const Scenery& scenery, const Lens& projector, const Pose& pose, const Vec3& eye, const Surfaces& surfaces,
           const SeenPoint* points, Lit* lit, std::size_t count) {
  light_seen_from(
      scenery, projector, pose, [&](std::size_t) { return eye; }, surfaces, points, lit, count,
      Scenery::Rays::side_by_side);
}

void light(const Scenery& scenery, const Lens& projector, const Pose& pose, const Surfaces& surfaces,
           const SeenPoint* points, const Vec3* eyes, Lit* lit, std::size_t count) {
  light_seen_from(
      scenery, projector, pose, [&](std::size_t i) { return eyes[i]; }, surfaces, points, lit, count,
      Scenery::Rays::scattered);
}

double gain_of(const ImagerSettings& imager, const std::vector<Lit>& lit, const std::vector<double>& depths,
               double light_z) {
  if (imager.reference_distance > 0.0) return imager.exposure * imager.reference_distance * imager.reference_distance;
  std::vector<double> losses;  // distance^2 / cosine
  for (std::size_t i = 0; i < lit.size(); ++i) {
    if (lit[i].code != Validity::valid) continue;
    const double distance = lit[i].distance;
    losses.push_back(distance * distance * distance / std::max(std::abs(depths[i] - light_z), 1e-6));
  }
  if (losses.empty()) return imager.exposure;
  const auto middle = losses.begin() + static_cast<std::ptrdiff_t>(losses.size() / 2);
  std::nth_element(losses.begin(), middle, losses.end());
  return imager.exposure * *middle;
}

}  // namespace bin_scenes
