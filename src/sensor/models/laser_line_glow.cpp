#include "sensor/models/laser_line.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace bin_scenes {

SheetGlow::Camera LaserLine::glow_camera() const {
  return {setup_.camera, upright_, setup_.near, setup_.far, setup_.settings.blur, 0.25 * setup_.line_width};
}

/// The light of the sheet that goes on from what it meets. It has the flux that its line shows in the image.
void LaserLine::follow(const Carriage& at, const std::vector<Hit>& hits, const Random& key, SheetGlow& glow) const {
  const double focal = upright_ ? setup_.camera.fx : setup_.camera.fy;
  std::vector<SheetGlow::Source> sources;
  for (std::size_t i = 0; i + 1 < hits.size(); ++i) {
    const Hit& hit = hits[i];
    if (std::isnan(hit.distance)) continue;
    const Vec3& ray = directions_[i];
    const Vec3 point = at.laser + hit.distance * ray;
    const double depth = std::clamp((to_camera_ * (point - at.eye)).z(), setup_.near, setup_.far);
    const double angle = std::atan2(ray.cross(directions_[i + 1]).norm(), ray.dot(directions_[i + 1]));
    const double line = std::sqrt(2.0 * M_PI) * sigma_at(depth) * depth / focal;  // m: as wide as one of even light
    sources.push_back({{point, hit.normal, hit.line, true, hit.label},
                       setup_.settings.power * reference_ * line * angle,
                       hit.distance * ray.norm() * angle});
  }
  const auto count = static_cast<std::size_t>(setup_.indirect.samples) * directions_.size() / 32;
  glow.follow({at.eye, setup_.camera_pose.orientation}, at.laser, sources, count, setup_.indirect.bounces, key);
}

/// Where other surfaces' light is brightest beside the lines of a sample, the device may see one more. What lies there
/// is asked by a ray.
void LaserLine::add_second_lines(const Carriage& at, const SheetGlow& glow, std::vector<Line>& lines) const {
  std::vector<std::pair<int, int>> places;  // sample, pixel across
  std::vector<std::pair<int, int>> taken;
  auto line = lines.begin();
  for (int s = 0; s < samples_; ++s) {
    taken.clear();
    for (; line != lines.end() && line->sample == s; ++line) {
      if (!line->visible) continue;
      const int center = static_cast<int>(std::lround(line->across)), reach = reach_of(sigma_at(line->depth));
      taken.emplace_back(center - reach, center + reach);
    }
    const int place = glow.brightest(s, setup_.settings.min_signal / scales_.front(), taken);
    if (place >= 0) places.emplace_back(s, place);
  }
  std::vector<Ray> rays;
  for (const auto& [sample, across] : places) {
    const Vec3 ray = upright_ ? setup_.camera.ray(across, sample) : setup_.camera.ray(sample, across);
    rays.push_back({at.eye, setup_.camera_pose.orientation * ray, setup_.near, setup_.far});
  }
  std::vector<Hit> hits(rays.size());
  scenery_.first_hits(rays.data(), hits.data(), rays.size());
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const Hit& hit = hits[i];
    if (std::isnan(hit.distance)) continue;
    Line second{};
    second.sample = places[i].first;
    second.across = static_cast<double>(places[i].second);
    second.depth = hit.distance;
    second.point = at.eye + hit.distance * rays[i].direction;
    second.normal = hit.normal;
    second.label = hit.label;
    second.visible = true;
    lines.push_back(second);
  }
  std::stable_sort(lines.begin(), lines.end(), [](const Line& a, const Line& b) { return a.sample < b.sample; });
}

}  // namespace bin_scenes
