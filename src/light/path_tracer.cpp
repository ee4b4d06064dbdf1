/// What a row's paths see first is drawn. From there all paths of a few pixels go from surface to surface together:
/// Embree takes rays in eights.
#include "light/path_tracer.hpp"

#include "light/unit_circle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace bin_scenes {

namespace {

constexpr std::size_t block_pixels = 64;
/// What is drawn for a path: its place in the pixel, the blur, a point of the lens, and at each surface a point of a
/// lamp and a direction.
enum Decision { place, blurred, on_lens, first_surface };
enum DecisionOfSurface { on_lamp, along_lobe, decisions_of_surface };

constexpr double infinite = std::numeric_limits<double>::infinity();

Rgb in_colour(const Surface& surface, double matte, double mirrored) {
  const Rgb colour = surface.colour.array();
  return surface.metal() ? Rgb((matte + mirrored) * colour) : Rgb(matte * colour + mirrored);
}

Surfaces softened(Surfaces surfaces, double soft) {
  if (!(soft > 0.0)) return surfaces;
  const auto soften = [&](Surface& surface) {
    surface.roughness = std::max(surface.roughness, soft);
    surface.anisotropy = surface.texture.oil = 0.0;
  };
  std::for_each(surfaces.lines.begin(), surfaces.lines.end(), soften);
  soften(surfaces.bin);
  soften(surfaces.table.surface);
  return surfaces;
}

}  // namespace

/// A row of pixels, and what all their paths see first.
struct PathTracer::Row {
  std::size_t index = 0;
  EvenPoints::Row points;
  std::vector<Spot> spots;  // by pixel and sample
  bool drawn = false;
};

struct PathTracer::Block {
  const Row* row = nullptr;
  std::size_t first = 0;                     // pixel of the row
  std::vector<std::array<Rgb, 2>> radiance;  // by pixel, of even and odd paths
  std::vector<Vertex> vertices, next;
  std::vector<Ray> rays;
  std::vector<Hit> hits;
  std::vector<std::uint8_t> blocked;
  struct Asked {
    std::uint32_t pixel, half;
    Rgb light;
  };
  std::vector<Asked> asked;
  std::vector<Ray> asked_rays;
  struct Followed {
    const Vertex* from;
    bool mirrors;
    Lobe::Sample sample;
    Rgb weight;
  };
  std::vector<Followed> followed, outward;  // outward: only whether something lies there has to be known
  std::vector<Ray> outward_rays;
};

PathTracer::PathTracer(const Scenery& scenery, const Lens& lens, const Pose& pose, const Surfaces& surfaces,
                       const Lamps& lamps, const Setup& setup, const Random& key)
    : scenery_(scenery),
      lens_(lens),
      pose_(pose),
      turn_(pose.orientation.toRotationMatrix()),
      surfaces_(surfaces),
      soft_(softened(surfaces, setup.soft)),
      lamps_(lamps),
      setup_(setup),
      points_(key, first_surface + (setup.bounces + 1) * decisions_of_surface),
      spots_(scenery, lens, pose, setup.near, setup.far) {}

std::vector<Rgb> PathTracer::row(std::size_t index, Grain* grain) const {
  const auto width = static_cast<std::size_t>(lens_.width);
  thread_local Row row;  // both keep their memory
  thread_local Block block;
  row.index = index;
  points_.begin(row.points, index, width);
  see(row);
  std::vector<Rgb> radiance;
  radiance.reserve(width);
  for (std::size_t first = 0; first < width; first += block_pixels) {
    begin(block, row, first, std::min(block_pixels, width - first));
    add_seen(block);
    for (std::size_t i = 0; grain && i < block.radiance.size(); ++i) grain[first + i].sides = sides_of(block, i);
    for (int bounce = 0; bounce <= setup_.bounces && !block.vertices.empty(); ++bounce) leave(block, bounce);
    for (const auto& [even, odd] : block.radiance) {
      if (grain)
        grain[radiance.size()].variance = static_cast<float>(std::pow((even - odd).mean() / setup_.samples, 2));
      radiance.push_back((even + odd) / setup_.samples);
    }
  }
  return radiance;
}

Eigen::Vector2d PathTracer::drawn(const Row& row, std::size_t column, int decision, std::uint32_t sample) const {
  return row.points.at(column, decision, sample, static_cast<std::uint32_t>(setup_.samples));
}

Eigen::Vector2d PathTracer::drawn(const Block& block, const Vertex& vertex, int decision) const {
  return drawn(*block.row, block.first + vertex.pixel, decision, vertex.sample);
}

void PathTracer::see(Row& row) const {
  row.spots.clear();
  for (std::size_t column = 0; column < static_cast<std::size_t>(lens_.width); ++column) {
    for (std::uint32_t s = 0; s < static_cast<std::uint32_t>(setup_.samples); ++s) {
      Eigen::Vector2d at = drawn(row, column, place, s) - Eigen::Vector2d(0.5, 0.5);
      if (setup_.blur > 0.0) {
        const Eigen::Vector2d normal = drawn(row, column, blurred, s);
        at += setup_.blur * std::sqrt(-2.0 * std::log(1.0 - normal.x())) * on_unit_circle(normal.y());
      }
      Spot spot;
      spot.u = static_cast<double>(column) + at.x(), spot.v = static_cast<double>(row.index) + at.y();
      spot.near = 1.0 / setup_.far;
      row.spots.push_back(spot);
    }
  }
  row.drawn = setup_.aperture == 0.0 && spots_.draw(row.spots.data(), row.spots.size());
}

/// Rays to what is seen first, and what they hit.
void PathTracer::begin(Block& block, const Row& row, std::size_t first, std::size_t count) const {
  const auto samples = static_cast<std::size_t>(setup_.samples);
  block.row = &row;
  block.first = first;
  block.radiance.assign(count, {Rgb::Zero(), Rgb::Zero()});
  block.rays.clear();
  block.hits.resize(count * samples);
  for (std::size_t i = 0; i < block.hits.size(); ++i) {
    const Spot& spot = row.spots[first * samples + i];
    block.rays.push_back(ray_of(row, first + i / samples, static_cast<std::uint32_t>(i % samples)));
    if (!row.drawn) continue;
    if (lens_.inside({spot.u, spot.v}))
      block.hits[i] = scenery_.hit(block.rays[i], spot.face, 1.0 / spot.near);
    else  // blur reaches beyond what is drawn
      scenery_.first_hits(&block.rays[i], &block.hits[i], 1);
  }
  if (!row.drawn) scenery_.first_hits(block.rays.data(), block.hits.data(), block.rays.size());
}

/// Through a point of the aperture to where the ray through its centre meets the plane in focus (Cook, Porter,
/// Carpenter 1984, "Distributed ray tracing").
Ray PathTracer::ray_of(const Row& row, std::size_t column, std::uint32_t sample) const {
  const Spot& spot = row.spots[column * static_cast<std::size_t>(setup_.samples) + sample];
  const bool plain = !lens_.distorts() && lens_.skew == 0.0;
  const Vec3 ray =
      plain ? Vec3((spot.u - lens_.cx) / lens_.fx, (spot.v - lens_.cy) / lens_.fy, 1.0) : lens_.ray(spot.u, spot.v);
  if (setup_.aperture == 0.0) return {pose_.position, turn_ * ray, setup_.near, setup_.far};
  const Eigen::Vector2d at = drawn(row, column, on_lens, sample);
  const Eigen::Vector2d disc = 0.5 * setup_.aperture * std::sqrt(at.x()) * on_unit_circle(at.y());
  const Vec3 start(disc.x(), disc.y(), 0.0);
  return {pose_ * start, turn_ * (ray - start / setup_.focus), setup_.near, setup_.far};
}

void PathTracer::find_blocked(const std::vector<Ray>& rays, std::vector<std::uint8_t>& blocked,
                              Scenery::Rays kind) const {
  blocked.resize(rays.size());
  scenery_.blocked(rays.data(), blocked.data(), rays.size(), kind);
}

void PathTracer::add_seen(Block& block) const {
  const auto samples = static_cast<std::uint32_t>(setup_.samples);
  block.vertices.clear();
  for (std::uint32_t i = 0; i < block.rays.size(); ++i) {
    const Ray& ray = block.rays[i];
    const Hit& hit = block.hits[i];
    if (!ray.direction.allFinite()) continue;
    const double length = ray.direction.norm(), reach = std::isnan(hit.distance) ? infinite : hit.distance * length;
    block.radiance[i / samples][i % 2] += lamps_.met(ray.origin, ray.direction / length, reach, Lamps::Met::all, 1.0);
    Vertex vertex;
    vertex.pixel = i / samples, vertex.sample = i % samples;
    vertex.to_eye = -ray.direction / length;
    add_vertex(block.vertices, ray, hit, vertex);
  }
}

bool PathTracer::Side::takes(const Eigen::Vector3f& other, const Eigen::Vector3f& its_normal, std::uint16_t of,
                             float off) const {
  return label == of && normal.dot(its_normal) > static_cast<float>(bends) && std::abs(normal.dot(other - point)) < off;
}

std::array<PathTracer::Side, 2> PathTracer::sides_of(const Block& block, std::size_t pixel) const {
  const auto samples = static_cast<std::size_t>(setup_.samples);
  const float path = 1.0f / static_cast<float>(setup_.samples);
  std::array<Side, 2> sides;
  for (std::size_t i = pixel * samples; i < (pixel + 1) * samples; ++i) {
    const Hit& hit = block.hits[i];
    if (std::isnan(hit.distance)) continue;
    const Ray& ray = block.rays[i];
    const Eigen::Vector3f point = (ray.origin + hit.distance * ray.direction).cast<float>();
    const Eigen::Vector3f normal = hit.normal.cast<float>();
    const auto footprint = static_cast<float>(hit.distance / lens_.fx);
    for (Side& side : sides) {
      if (side.share > 0.0f && !side.takes(point, normal, hit.label, footprint)) continue;
      if (side.share == 0.0f) side = {point, normal, hit.label, 0.0f};
      side.share += path;
      break;
    }
  }
  return sides;
}

void PathTracer::add_vertex(std::vector<Vertex>& to, const Ray& ray, const Hit& hit, Vertex vertex) const {
  if (std::isnan(hit.distance)) return;
  vertex.position = ray.origin + hit.distance * ray.direction;
  vertex.face = hit.normal;
  vertex.normal = scenery_.smooth_normal(hit, vertex.position);
  if (setup_.bevels) vertex.normal = setup_.bevels->normal(hit, vertex.position, vertex.normal);
  // A smooth surface that turns away from where it is seen from is none: its face is.
  if (vertex.normal.dot(vertex.to_eye) < 0.02) vertex.normal = vertex.face;
  vertex.line = hit.line, vertex.label = hit.label;
  to.push_back(vertex);
}

const Surface& PathTracer::surface_of(const Vertex& vertex, int bounce, Surface& own) const {
  return (bounce == 0 ? surfaces_ : soft_).at(vertex.line, vertex.label, vertex.position, own);
}

/// Rays to lamps and along lobes, from all surfaces that the paths have reached.
void PathTracer::leave(Block& block, int bounce) const {
  block.asked.clear(), block.asked_rays.clear();
  block.followed.clear(), block.rays.clear();
  block.outward.clear(), block.outward_rays.clear();
  for (const Vertex& v : block.vertices) {
    Surface own;
    const Surface& surface = surface_of(v, bounce, own);
    std::optional<Lobe> lobe;
    if (bounce < setup_.bounces || lamps_.any_met(weight_of(mirrors(surface, bounce))))
      lobe.emplace(surface, v.normal, v.to_eye);
    if (lamps_.any_sampled()) ask_lamp(block, v, surface, lobe ? &*lobe : nullptr, bounce);
    if (lobe) follow(block, v, surface, *lobe, bounce);
  }
  find_lit(block, bounce);
  find_ends(block);
}

/// @param lobe  of the surface; null: no ray along it can meet the lamps that points are drawn on
void PathTracer::ask_lamp(Block& block, const Vertex& v, const Surface& surface, const Lobe* lobe, int bounce) const {
  const Eigen::Vector2d at = drawn(block, v, first_surface + bounce * decisions_of_surface + on_lamp);
  const Lamps::Sample lamp = lamps_.sample(v.position, at.x(), at.y());
  if (!(v.face.dot(lamp.direction) > 0.0 && (lamp.light > 0.0).any())) return;
  const SentBack sent = sent_back(surface, v.normal, lamp.direction, v.to_eye);
  if (!(sent.matte + sent.mirrored > 0.0)) return;
  double share = 1.0;
  if (lamp.density > 0.0 && setup_.by == Setup::By::lobe) return;
  if (lamp.density > 0.0 && setup_.by == Setup::By::both && mirrors(surface, bounce))
    share = lamp.density / (lamp.density + lobe->density_of(lamp.direction));
  const Rgb light = v.weight * lamp.light * in_colour(surface, sent.matte, sent.mirrored) * (share / M_PI);
  block.asked.push_back({v.pixel, v.sample % 2, light});
  block.asked_rays.push_back(ray_between(v.position, v.face, v.position + lamp.distance * lamp.direction));
}

/// Of lamps that a ray meets which left along a lobe.
Lamps::Met PathTracer::weight_of(bool mirrors) const {
  if (setup_.by == Setup::By::lobe) return Lamps::Met::all;
  return mirrors && setup_.by == Setup::By::both ? Lamps::Met::shared : Lamps::Met::unsampled;
}

void PathTracer::follow(Block& block, const Vertex& v, const Surface& surface, const Lobe& lobe, int bounce) const {
  const Eigen::Vector2d at = drawn(block, v, first_surface + bounce * decisions_of_surface + along_lobe);
  const Lobe::Sample sample = lobe.at(at.x(), at.y());
  if (!(sample.factor > 0.0 && v.face.dot(sample.direction) > 0.0)) return;
  const Ray ray = ray_along(v.position, v.face, sample.direction);
  const bool mirrors = this->mirrors(surface, bounce);
  const Lamps::Met weight = weight_of(mirrors);
  const bool hits = bounce < setup_.bounces || lamps_.flat_ahead(ray.origin, ray.direction, weight);
  if (!hits && !lamps_.any_behind_all(weight)) return;
  const Rgb path = v.weight * in_colour(surface, sample.matte, sample.factor - sample.matte);
  (hits ? block.followed : block.outward).push_back({&v, mirrors, sample, path});
  (hits ? block.rays : block.outward_rays).push_back(ray);
}

/// The light of those lamps that nothing blocks.
void PathTracer::find_lit(Block& block, int bounce) const {
  find_blocked(block.asked_rays, block.blocked, bounce == 0 ? Scenery::Rays::side_by_side : Scenery::Rays::scattered);
  for (std::size_t i = 0; i < block.asked.size(); ++i)
    if (!block.blocked[i]) block.radiance[block.asked[i].pixel][block.asked[i].half] += block.asked[i].light;
}

/// Where paths end that follow lobes: the lamps that they meet there, and the surfaces from which they go on.
void PathTracer::find_ends(Block& block) const {
  const auto add = [&](const Block::Followed& path, const Ray& ray, double reach) {
    block.radiance[path.from->pixel][path.from->sample % 2] +=
        path.weight * lamps_.met(ray.origin, ray.direction, reach, weight_of(path.mirrors), path.sample.density);
  };
  find_blocked(block.outward_rays, block.blocked, Scenery::Rays::scattered);
  for (std::size_t i = 0; i < block.outward.size(); ++i)
    if (!block.blocked[i]) add(block.outward[i], block.outward_rays[i], infinite);
  block.hits.resize(block.rays.size());
  scenery_.first_hits(block.rays.data(), block.hits.data(), block.rays.size(), Scenery::Rays::scattered);
  block.next.clear();
  for (std::size_t i = 0; i < block.followed.size(); ++i) {
    const Block::Followed& path = block.followed[i];
    const double reach = block.hits[i].distance;
    add(path, block.rays[i], std::isnan(reach) ? infinite : reach);
    Vertex vertex = *path.from;
    vertex.to_eye = -path.sample.direction;
    vertex.weight = path.weight;
    add_vertex(block.next, block.rays[i], block.hits[i], vertex);
  }
  std::swap(block.vertices, block.next);
}

}  // namespace bin_scenes
