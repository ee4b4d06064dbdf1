/// How much light of a projector a surface sends to an eye, and which points lie in shadow. Rays are asked where
/// neither clear sight nor a drawing decides.
#include "light/illumination.hpp"

#include "light/facets.hpp"
#include "raster/sight.hpp"
#include "raster/spots.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

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

Ray ray_along(const Vec3& surface, const Vec3& normal, const Vec3& direction) {
  constexpr double gap = 1e-5;  // m
  return {surface + gap * normal, direction, 0.0, 1e9};
}

Ray ray_between(const Vec3& surface, const Vec3& normal, const Vec3& point) {
  const Vec3 start = ray_along(surface, normal, normal).origin;
  return {start, point - start, 0.0, 1.0};
}

SeenPoint point_of(const Ray& ray, const Hit& hit) {
  return {ray.origin + hit.distance * ray.direction, hit.normal, hit.line, !std::isnan(hit.distance), hit.label};
}

namespace {

/// Sets all but what is reflected. False: no light can come to the point, whatever lies between.
/// @param there  the point in the light's frame
/// @param plain  the light's lens does not distort
bool falls_on(const LightSource& source, const SeenPoint& p, const Vec3& there, bool plain, Lit& lit) {
  lit = {};
  if (!p.hit) return false;
  lit.code = Validity::outside;
  const Lens& lens = source.lens;
  Eigen::Vector2d pixel;
  if (!plain || !(there.z() > 0.0)) {
    const auto projected = lens.project(there);
    if (!projected) return false;
    pixel = *projected;
  } else {
    const double x = there.x() / there.z(), y = there.y() / there.z();
    pixel = {lens.fx * x + lens.skew * y + lens.cx, lens.fy * y + lens.cy};
  }
  lit.column = pixel.x();
  lit.row = pixel.y();
  lit.distance = (source.pose.position - p.position).norm();
  if (!lens.inside(pixel)) return false;
  lit.code = Validity::shadow;
  return p.normal.dot(source.pose.position - p.position) > 0.0;  // else the camera sees the other side
}

/// Whether something lies between the light and where each ray begins.
std::vector<std::uint8_t> shaded(const LightSource& source, const Mat3& turn, const std::vector<Ray>& rays,
                                 Scenery::Rays kind) {
  std::vector<std::uint8_t> blocked(rays.size());
  if (source.occlusion) {
    std::vector<Spot> spots(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Vec3 p = turn * (rays[i].origin - source.pose.position);
      spots[i].near = 1.0 / p.z();
      spots[i].u = source.lens.fx * p.x() * spots[i].near + source.lens.cx;
      spots[i].v = source.lens.fy * p.y() * spots[i].near + source.lens.cy;
    }
    if (source.occlusion->draw(spots.data(), spots.size())) {
      for (std::size_t i = 0; i < rays.size(); ++i) blocked[i] = spots[i].face != Scenery::no_face;
      return blocked;
    }
  }
  source.scenery.blocked(rays.data(), blocked.data(), rays.size(), kind);
  return blocked;
}

/// @param eye_of  by number of the point
template <class EyeOf>
void light_seen_from(const LightSource& source, const EyeOf& eye_of, const SeenPoint* points, Lit* lit,
                     std::size_t count, Scenery::Rays kind) {
  const Vec3& light = source.pose.position;
  const Mat3 turn = source.pose.orientation.toRotationMatrix().transpose();
  std::vector<Ray> rays;
  std::vector<std::size_t> asked;
  rays.reserve(count);
  asked.reserve(count);
  const auto shine = [&](std::size_t i) {
    const SeenPoint& p = points[i];
    Surface own;
    lit[i].code = Validity::valid;
    lit[i].reflected = reflected(source.surfaces.at(p.line, p.label, p.position, own), p.normal,
                                 (light - p.position) / lit[i].distance, (eye_of(i) - p.position).normalized());
  };
  const bool plain = !source.lens.distorts();
  std::uint32_t number = Scenery::no_face;
  Scenery::Face face;
  for (std::size_t i = 0; i < count; ++i) {
    const SeenPoint& p = points[i];
    const Vec3 there = turn * (p.position - light);
    if (!falls_on(source, p, there, plain, lit[i])) continue;
    if (p.face != number) face = source.scenery.face(number = p.face);
    if (source.sight && source.sight->clear(p.position, there, {lit[i].column, lit[i].row}, face)) {
      shine(i);
      continue;
    }
    rays.push_back(ray_between(p.position, p.normal, light));
    asked.push_back(i);
  }
  const std::vector<std::uint8_t> blocked = shaded(source, turn, rays, kind);
  for (std::size_t k = 0; k < asked.size(); ++k) {
    if (!blocked[k]) shine(asked[k]);
  }
}

}  // namespace

void light(const LightSource& source, const Vec3& eye, const SeenPoint* points, Lit* lit, std::size_t count) {
  light_seen_from(
      source, [&](std::size_t) { return eye; }, points, lit, count, Scenery::Rays::side_by_side);
}

void light(const LightSource& source, const Vec3* eyes, const SeenPoint* points, Lit* lit, std::size_t count) {
  light_seen_from(
      source, [&](std::size_t i) { return eyes[i]; }, points, lit, count, Scenery::Rays::scattered);
}

}  // namespace bin_scenes
