/// The lines of a profile that its camera could see: by the rays of the fan that meet one surface side by side, and up
/// to the edges of surfaces between rays that do not.
#include "sensor/models/laser_line.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace bin_scenes {

namespace {

/// m: two hits of neighbouring rays are on different surfaces if each lies off the other's plane by more.
constexpr double edge = 1e-3;

/// Depth step between two hits of neighbouring rays, as the plane of either says.
bool one_surface(const Hit& a, const Vec3& along_a, const Hit& b, const Vec3& along_b) {
  if (std::isnan(a.distance) || std::isnan(b.distance) || a.label != b.label) return false;
  const double b_on_a = a.distance * a.normal.dot(along_a) / a.normal.dot(along_b);
  const double a_on_b = b.distance * b.normal.dot(along_b) / b.normal.dot(along_a);
  return std::abs(b_on_a - b.distance) < edge || std::abs(a_on_b - a.distance) < edge;
}

}  // namespace

/// The line that a sample shows on the plane of what ray `own` hit, lit through the fan between the rays of a span on
/// that plane. By secants: exact on a plane, whatever the lens does.
std::optional<LaserLine::Line> LaserLine::line_at(const Carriage& at, int sample, const Hit& hit, std::size_t own,
                                                  const Span& span) const {
  const double plane = hit.distance * hit.normal.dot(directions_[own]);
  double share = (sample - span.at_a) / (span.at_b - span.at_a);
  Vec3 direction, point;
  std::optional<Eigen::Vector2d> pixel;
  for (int k = 0; k < 4; ++k) {
    direction = (1.0 - share) * directions_[span.a] + share * directions_[span.b];
    point = at.laser + plane / hit.normal.dot(direction) * direction;
    pixel = pixel_of(at, point);
    if (!pixel) return std::nullopt;
    const double off = sample - along(*pixel);
    if (std::abs(off) < 1e-9) break;
    share += off / (span.at_b - span.at_a);
  }
  const double limit = (upright_ ? setup_.camera.width : setup_.camera.height) - 0.5;
  if (across(*pixel) < -0.5 || across(*pixel) > limit) return std::nullopt;
  // The fan's normal is turned towards the laser; what the camera sees from behind, it does not see lit.
  const double distance = (at.laser - point).norm();
  Surface worn_there;
  const double light = reflected(surfaces_.at(hit.line, hit.label, point, worn_there), hit.normal,
                                 (at.laser - point) / distance, (at.eye - point).normalized());
  Line line;
  line.sample = sample;
  line.across = across(*pixel);
  line.depth = (to_camera_ * (point - at.eye)).z();
  line.signal = setup_.settings.power * light * reference_ / distance;
  line.point = point;
  line.normal = hit.normal;
  line.label = hit.label;
  line.visible = light > 0.0;
  return line;
}

/// Between a ray and its neighbour that does not meet the same surface, each surface goes on to its edge. Which samples
/// it still covers is asked by a ray to each.
void LaserLine::extend(const Carriage& at, const std::vector<Hit>& hits, std::size_t own, std::size_t next,
                       std::vector<Line>& asked) const {
  const Hit& hit = hits[own];
  const double distance = hit.distance * hit.normal.dot(directions_[own]) / hit.normal.dot(directions_[next]);
  if (!(distance > 0.0 && std::isfinite(distance))) return;  // the plane ends before
  const auto from = pixel_of(at, at.laser + hit.distance * directions_[own]),
             to = pixel_of(at, at.laser + distance * directions_[next]);
  if (!from || !to) return;
  const double begin = along(*from), end = along(*to);
  const int first = std::max(0, static_cast<int>(std::ceil(std::min(begin, end))));
  const int last = std::min(samples_ - 1, static_cast<int>(std::floor(std::max(begin, end))));
  for (int s = first; s <= last; ++s) {
    if (s == begin) continue;  // belongs to the rays on the other side
    if (const auto line = line_at(at, s, hit, own, {own, begin, next, end})) asked.push_back(*line);
  }
}

void LaserLine::find_lines(const Carriage& at, const std::vector<Hit>& hits, Lines& out) const {
  const auto sample_of = [&](std::size_t i) -> std::optional<double> {
    if (std::isnan(hits[i].distance)) return std::nullopt;
    const auto pixel = pixel_of(at, at.laser + hits[i].distance * directions_[i]);
    return pixel ? std::optional<double>(along(*pixel)) : std::nullopt;
  };
  out.lines.clear();
  out.codes.assign(static_cast<std::size_t>(samples_), Validity::outside);
  const auto first_of = [&](double a, double b) { return std::max(0, static_cast<int>(std::ceil(std::min(a, b)))); };
  const auto last_of = [&](double a, double b) {
    return std::min(samples_ - 1, static_cast<int>(std::floor(std::max(a, b))));
  };
  const auto fill = [&](double a, double b, Validity code) {
    for (int s = first_of(a, b); s <= last_of(a, b); ++s) out.codes[static_cast<std::size_t>(s)] = code;
  };

  const Vec3 fan_direction = to_camera_ * (directions_.back() - directions_.front());
  const bool rising =
      (upright_ ? fan_direction.y() : fan_direction.x()) > 0.0;  // samples, from the first ray to the last
  const double first_side = rising ? 0.0 : samples_, last_side = rising ? samples_ : 0.0;
  std::vector<Line> asked;
  std::optional<double> before;  // sample of the last hit
  std::size_t last = 0;          // and its number
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const std::optional<double> here = sample_of(i);
    if (!here) continue;
    const bool neighbours = before && last + 1 == i;
    if (neighbours && one_surface(hits[last], directions_[last], hits[i], directions_[i])) {
      for (int s = first_of(*before, *here); s <= last_of(*before, *here); ++s) {
        const std::size_t own = std::abs(s - *before) < std::abs(s - *here) ? last : i;
        if (const auto line = line_at(at, s, hits[own], own, {last, *before, i, *here})) out.lines.push_back(*line);
      }
    } else {
      if (before) fill(*before, *here, neighbours ? Validity::shadow : Validity::nothing);
      if (!before && i > 0) fill(*here, first_side, Validity::nothing);
      if (before) extend(at, hits, last, last + 1, asked);
      if (i > 0) extend(at, hits, i, i - 1, asked);
    }
    before = here;
    last = i;
  }
  if (!before) fill(0.0, samples_, Validity::nothing);
  if (before && last + 1 < hits.size()) {
    fill(*before, last_side, Validity::nothing);
    extend(at, hits, last, last + 1, asked);
  }
  const auto by_sample = [](const Line& a, const Line& b) { return a.sample < b.sample; };
  std::stable_sort(asked.begin(), asked.end(), by_sample);
  keep_lit(at, asked, out.lines);
  for (const Line& line : out.lines) {
    out.codes[static_cast<std::size_t>(line.sample)] = Validity::shadow;  // unless the camera sees it
  }
  hide(at, out.lines);
  std::stable_sort(out.lines.begin(), out.lines.end(), by_sample);
}

/// Adds those of the lines asked, sorted by sample, that the laser meets where they were expected. Of two that it meets
/// in one place, on both sides of a crease, the nearer guess.
void LaserLine::keep_lit(const Carriage& at, const std::vector<Line>& asked, std::vector<Line>& lines) const {
  std::vector<Ray> rays(asked.size());
  std::vector<Hit> hits(asked.size());
  for (std::size_t i = 0; i < asked.size(); ++i) rays[i] = {at.laser, asked[i].point - at.laser, 0.0, 2.0};
  scenery_.first_hits(rays.data(), hits.data(), rays.size());
  const std::size_t first = lines.size();
  std::vector<double> offs(first);  // by line
  for (std::size_t i = 0; i < asked.size(); ++i) {
    const Line& line = asked[i];
    const double off = std::abs(hits[i].distance - 1.0) * rays[i].direction.norm();
    if (!(off < edge && hits[i].label == line.label)) continue;
    std::size_t k = lines.size();
    while (k > first && lines[k - 1].sample == line.sample && (lines[k - 1].point - line.point).norm() > edge) --k;
    const bool known = k > first && lines[k - 1].sample == line.sample;
    if (!known) {
      lines.push_back(line);
      offs.push_back(off);
    } else if (off < offs[k - 1]) {
      lines[k - 1] = line;
      offs[k - 1] = off;
    }
  }
}

/// Marks what the camera does not see.
void LaserLine::hide(const Carriage& at, std::vector<Line>& lines) const {
  std::vector<Ray> rays(lines.size());
  std::vector<std::uint8_t> hidden(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) rays[i] = ray_between(lines[i].point, lines[i].normal, at.eye);
  scenery_.blocked(rays.data(), hidden.data(), rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    Line& line = lines[i];
    line.visible = line.visible && !hidden[i] && line.depth >= setup_.near && line.depth <= setup_.far;
  }
}

}  // namespace bin_scenes
