/// The cells of a pixel: what each sees, and how it is lit.
#include "sensor/models/structured_light_strip.hpp"

#include <cmath>

namespace bin_scenes {

/// What a ray through the centre of each cell meets first.
void StructuredLight::Strip::first_hits(const std::vector<Place>& places, const std::vector<Ray>& rays,
                                        std::vector<Hit>& hits) const {
  std::vector<Spot> spots(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto& [index, cell] = places[i];
    spots[i].u = static_cast<double>(index % width_) + cells::across(cell);
    spots[i].v = static_cast<double>(index / width_) + cells::down(cell);
    spots[i].near = 1.0 / model_.setup_.far;
  }
  if (!model_.spots_.draw(spots.data(), spots.size())) {
    model_.scenery_.first_hits(rays.data(), hits.data(), rays.size());
    return;
  }
  for (std::size_t i = 0; i < places.size(); ++i)
    hits[i] = model_.scenery_.hit(rays[i], spots[i].face, 1.0 / spots[i].near);
}

/// What cells see and how it is lit.
std::vector<StructuredLight::Strip::Seen> StructuredLight::Strip::cast(const std::vector<Place>& places) const {
  const View& view = model_.view_;
  std::vector<Ray> rays(places.size());
  std::vector<Hit> hits(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto& [index, cell] = places[i];
    const Vec3 offset(cells::across(cell) / view.lens.fx, cells::down(cell) / view.lens.fy, 0.0);
    const Vec3 ray = model_.rays_.at(index % width_, index / width_) + offset;
    rays[i] = {view.pose.position, model_.turn_ * ray, model_.setup_.near, model_.setup_.far};
  }
  first_hits(places, rays, hits);
  std::vector<SeenPoint> points(places.size());
  std::vector<Lit> lit(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Hit& hit = hits[i];
    const Vec3 point = rays[i].origin + hit.distance * rays[i].direction;
    const std::uint32_t face = model_.scenery_.face_of(hit);
    points[i] = {point, hit.normal, hit.line, face != Scenery::no_face, hit.label, face};
  }
  light(model_.source(), view.pose.position, points.data(), lit.data(), lit.size());
  std::vector<Seen> seen(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    Surface own;
    const SeenPoint& p = points[i];
    const Surface& surface = p.hit ? model_.surfaces_.at(p.line, p.label, p.position, own) : own;
    seen[i] = {hits[i].distance, lit[i], hits[i].line, diffuse_share(surface)};
  }
  return seen;
}

StructuredLight::Strip::Phasors StructuredLight::Strip::phasors(const Cells& own, double turn) const {
  const Values phase = static_cast<float>(turn) * own.column;
  const Values none = Values::Zero();  // the column of a cell without light may be no number
  return {(own.white > 0.0f).select(own.white * phase.cos(), none),
          (own.white > 0.0f).select(own.white * phase.sin(), none)};
}

/// Cells asked by rays; the corners of pixels are known.
void StructuredLight::Strip::add_crossed(const std::vector<const Uneven*>& pixels) {
  std::vector<Place> places;
  for (const Uneven* const pixel : pixels) {
    for (int k = 0; k < per_pixel; ++k) {
      if (!cells::is_corner(k)) places.push_back({pixel->index, k});
    }
  }
  const std::vector<Seen> others = cast(places);
  std::size_t next = 0;
  for (const Uneven* const pixel : pixels) {
    std::array<Seen, per_pixel> seen;
    int corner = 0;
    for (int k = 0; k < per_pixel; ++k) seen[k] = cells::is_corner(k) ? pixel->corners[corner++] : others[next++];
    add_seen(pixel->index, seen);
  }
}

/// Cells of a pixel that will be removed as mixed: each sees what its corner does.
void StructuredLight::Strip::add_mixed(const Uneven& pixel) {
  std::array<Seen, per_pixel> seen;
  for (int k = 0; k < per_pixel; ++k) {
    seen[k] = pixel.corners[(cells::across(k) > 0.0 ? 1u : 0u) + (cells::down(k) > 0.0 ? 2u : 0u)];
  }
  add_seen(pixel.index, seen);
}

void StructuredLight::Strip::add_seen(std::size_t index, const std::array<Seen, per_pixel>& seen) {
  Cells own;
  for (int k = 0; k < per_pixel; ++k) {
    const Seen& s = seen[k];
    const bool lit = s.lit.code == Validity::valid;
    own.column[k] = static_cast<float>(s.lit.column);
    own.white[k] = lit ? static_cast<float>(s.lit.reflected / (s.lit.distance * s.lit.distance)) : 0.0f;
    own.depth[k] = static_cast<float>(s.depth);
    own.outside = own.outside || s.lit.code == Validity::outside;
    if (s.lit.code == Validity::nothing) continue;
    own.diffuse += static_cast<float>(s.diffuse) / per_pixel;
  }
  add(index, own);
}

/// Cells of one face in even light.
StructuredLight::Strip::Cells StructuredLight::Strip::flat(const Pixel& pixel, const Vec2& slope) const {
  const Lens& lens = model_.view_.lens;
  const std::size_t index = pixel.index;
  Cells own;
  own.diffuse = static_cast<float>(model_.diffuse(index));
  own.outside = model_.codes_[index] == Validity::outside;
  const auto right = static_cast<float>(pixel.normal.x() / lens.fx),
             below = static_cast<float>(pixel.normal.y() / lens.fy);
  const auto center = static_cast<float>(pixel.normal.dot(pixel.ray)), plane = static_cast<float>(pixel.plane);
  own.column = static_cast<float>(model_.columns_[index]) + static_cast<float>(slope.x()) * across_ +
               static_cast<float>(slope.y()) * down_;
  own.white.setConstant(model_.codes_[index] == Validity::valid ? static_cast<float>(model_.whites_[index]) : 0.0f);
  own.depth = plane / (center + right * across_ + below * down_);
  return own;
}

void StructuredLight::Strip::add_flat(std::size_t index) {
  const Pixel pixel = model_.pixel(index % width_, index / width_);
  Cells own = flat(pixel, model_.slope(pixel));
  add(index, own);
}

/// Cells of faces that bend gently: their columns leave those of the centre's face towards each corner's.
void StructuredLight::Strip::add_bent(const Uneven& bent) {
  const Pixel pixel = model_.pixel(bent.index % width_, bent.index / width_);
  const Vec2 slope = model_.slope(pixel);
  Cells own = flat(pixel, slope);
  for (int k = 0; k < per_pixel; ++k) {
    const double u = cells::across(k), v = cells::down(k);
    const int corner = (u > 0.0 ? 1 : 0) + (v > 0.0 ? 2 : 0), at = cells::corners[corner];
    const Seen& there = bent.corners[static_cast<std::size_t>(corner)];
    const double flat = model_.columns_[bent.index] + slope.x() * cells::across(at) + slope.y() * cells::down(at);
    const double share =
        std::sqrt((u * u + v * v) / (cells::across(at) * cells::across(at) + cells::down(at) * cells::down(at)));
    own.column[k] += static_cast<float>(share * (there.lit.column - flat));
  }
  add(bent.index, own);
}

void StructuredLight::Strip::add(std::size_t index, Cells& own) {
  own.phasors = phasors(own, model_.fringes_.turn());
  if (model_.second_) second_.push_back(phasors(own, model_.second_->turn()));
  own.white.maxCoeff(&own.brightest);
  cells_of_[index - origin_] = static_cast<std::int32_t>(cells_.size());
  cells_.push_back(own);
}

}  // namespace bin_scenes
