/// Points drawn on lamps, each by its share of all light, and what rays meet of them.
#include "light/lamps.hpp"

#include "bin_scenes/core/contact.hpp"
#include "light/unit_circle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bin_scenes {

namespace {

constexpr double beyond_all = 1e4;  ///< m

}  // namespace

Lamps::Lamps(std::vector<ImageLamp> lamps, const Sensor& sensor) {
  if (lamps.empty()) {
    lamps.emplace_back();
    lamps.back().type = ImageLamp::Type::dome;
  }
  for (const ImageLamp& lamp : lamps) {
    const Rgb radiance = lamp.radiance * lamp.colour.array();
    if (lamp.type == ImageLamp::Type::dome && lamp.picture.empty())
      domes_.push_back({radiance, lamp.horizon * radiance});
    if (lamp.type == ImageLamp::Type::dome && !lamp.picture.empty())
      skies_.emplace_back(read_panorama(lamp.picture), radiance, lamp.turn);
    if (lamp.type == ImageLamp::Type::projector)
      beams_.push_back({lens_of(sensor.projector), *sensor.projector.pose, radiance});
    const bool ring = lamp.type == ImageLamp::Type::ring;
    if (!ring && lamp.type != ImageLamp::Type::area) continue;
    const Pose pose = lamp.pose.value_or(*sensor.pose);
    const Mat3 axes = pose.orientation.toRotationMatrix();
    Flat flat;
    flat.center = pose.position;
    flat.x = axes.col(0), flat.y = axes.col(1), flat.normal = axes.col(2);
    flat.radiance = radiance;
    flat.ring = ring;
    flat.width = ring ? lamp.inner : lamp.width;
    flat.height = ring ? lamp.outer : lamp.height;
    flat.area = ring ? M_PI * (lamp.outer * lamp.outer - lamp.inner * lamp.inner) : lamp.width * lamp.height;
    flats_.push_back(flat);
  }
  for (const Flat& flat : flats_) shares_.push_back(flat.radiance.mean() * flat.area);
  for (const Beam& beam : beams_) shares_.push_back(beam.radiance.mean() * M_PI);
  for (const Sky& sky : skies_) shares_.push_back(sky.flux());
  double sum = 0.0;
  for (const double share : shares_) sum += share;
  for (double& share : shares_) share = sum > 0.0 ? share / sum : 1.0 / static_cast<double>(shares_.size());
}

void Lamps::add_everywhere(double radiance) {
  domes_.push_back({Rgb::Constant(radiance), Rgb::Constant(radiance)});
}

void Lamps::sample_flat(const Flat& flat, double share, const Vec3& from, double u, double v, Sample& out) const {
  Vec3 point = flat.center;
  if (flat.ring) {
    const double inner = flat.width * flat.width, outer = flat.height * flat.height;
    const Eigen::Vector2d disc = std::sqrt(inner + u * (outer - inner)) * on_unit_circle(v);
    point += disc.x() * flat.x + disc.y() * flat.y;
  } else {
    point += (u - 0.5) * flat.width * flat.x + (v - 0.5) * flat.height * flat.y;
  }
  const Vec3 offset = point - from;
  out.distance = offset.norm();
  out.direction = offset / out.distance;
  const double cosine = -flat.normal.dot(out.direction);
  if (!(cosine > 0.0)) return;
  out.density = share * out.distance * out.distance / (flat.area * cosine);
  out.light = flat.radiance / out.density;
}

void Lamps::sample_beam(const Beam& beam, double share, const Vec3& from, Sample& out) {
  const Vec3 offset = beam.pose.position - from;
  out.distance = offset.norm();
  out.direction = offset / out.distance;
  const auto pixel = beam.lens.project(beam.pose.inverse() * from);
  if (pixel && beam.lens.inside(*pixel)) out.light = M_PI * beam.radiance / (share * out.distance * out.distance);
}

/// Each lamp has a part of the interval of u. Points that are even in the whole are even in the part as well.
Lamps::Sample Lamps::sample(const Vec3& from, double u, double v) const {
  Sample out;
  std::size_t lamp = 0;
  while (lamp + 1 < shares_.size() && u >= shares_[lamp]) u -= shares_[lamp++];
  sample_one(lamp, shares_[lamp], from, std::min(u / shares_[lamp], 1.0), v, out);
  return out;
}

void Lamps::sample_one(std::size_t lamp, double share, const Vec3& from, double u, double v, Sample& out) const {
  if (lamp < flats_.size()) return sample_flat(flats_[lamp], share, from, u, v, out);
  lamp -= flats_.size();
  if (lamp < beams_.size()) return sample_beam(beams_[lamp], share, from, out);
  const Sky& sky = skies_[lamp - beams_.size()];
  const Sky::Sample drawn = sky.sample(u, v);
  out.direction = drawn.direction;
  out.distance = beyond_all;
  out.density = share * drawn.density;
  if (out.density > 0.0) out.light = sky.at(out.direction) / out.density;
}

double Lamps::distance_to(const Flat& flat, const Vec3& origin, const Vec3& direction) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const double cosine = -flat.normal.dot(direction);
  if (!(cosine > 0.0)) return none;
  const double distance = flat.normal.dot(origin - flat.center) / cosine;
  if (!(distance > 0.0)) return none;
  const Vec3 place = origin + distance * direction - flat.center;
  const double x = place.dot(flat.x), y = place.dot(flat.y), square = x * x + y * y;
  const bool inside = flat.ring ? square >= flat.width * flat.width && square <= flat.height * flat.height
                                : std::abs(x) <= 0.5 * flat.width && std::abs(y) <= 0.5 * flat.height;
  return inside ? distance : none;
}

bool Lamps::flat_ahead(const Vec3& origin, const Vec3& direction, Met weight) const {
  return weight != Met::unsampled && std::any_of(flats_.begin(), flats_.end(), [&](const Flat& flat) {
           return !std::isnan(distance_to(flat, origin, direction));
         });
}

Rgb Lamps::met(const Vec3& origin, const Vec3& direction, double reach, Met weight, double density) const {
  Rgb sum = Rgb::Zero();
  for (std::size_t i = 0; weight != Met::unsampled && i < flats_.size(); ++i) {
    const Flat& flat = flats_[i];
    const double distance = distance_to(flat, origin, direction);
    if (!(distance < reach)) continue;
    const double drawn = shares_[i] * distance * distance / (flat.area * -flat.normal.dot(direction));
    sum += (weight == Met::all ? 1.0 : density / (density + drawn)) * flat.radiance;
  }
  if (!std::isinf(reach)) return sum;
  for (const Dome& dome : domes_) sum += dome.at(direction.z());
  for (std::size_t i = 0; weight != Met::unsampled && i < skies_.size(); ++i) {
    const double drawn = shares_[flats_.size() + beams_.size() + i] * skies_[i].density(direction);
    sum += (weight == Met::all ? 1.0 : density / (density + drawn)) * skies_[i].at(direction);
  }
  return sum;
}

Rgb Lamps::on_plate(const Vec3& point, const Vec3& normal) const {
  constexpr int side = 64;
  Rgb sum = Rgb::Zero();
  const Tangents along(normal);
  for (int i = 0; i < side; ++i) {
    for (int k = 0; k < side; ++k) {
      const double u = (i + 0.5) / side, v = (k + 0.5) / side, turn = 2.0 * M_PI * v, radius = std::sqrt(u);
      const Vec3 offset = radius * (std::cos(turn) * along.x + std::sin(turn) * along.y) + std::sqrt(1.0 - u) * normal;
      for (const Dome& dome : domes_) sum += dome.at(offset.z());
      for (std::size_t lamp = 0; lamp < shares_.size(); ++lamp) {
        Sample sample;
        sample_one(lamp, 1.0, point, u, v, sample);
        if (sample.distance > 0.0) sum += sample.light * std::max(0.0, normal.dot(sample.direction)) / M_PI;
      }
    }
  }
  return sum / (side * side);
}

}  // namespace bin_scenes
