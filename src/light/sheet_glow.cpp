/// Light of a laser sheet that surfaces throw on to others: rays from the lit line, gathered by pixel columns.
#include "light/sheet_glow.hpp"

#include "light/lobe.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace bin_scenes {

namespace {

constexpr int coarse_cell = 8;       // pixel, across and along
constexpr double widest = 48.0;      // pixel: of what is spread wider, the centre
const double tent = std::sqrt(6.0);  // half width of a tent / its standard deviation

/// Digits of a number behind the point, in reverse order: places that fill [0, 1) evenly (Halton's).
double reversed_digits(std::size_t number, unsigned base) {
  double place = 1.0, sum = 0.0;
  for (; number > 0; number /= base) sum += (place /= base) * static_cast<double>(number % base);
  return sum;
}

double wrapped(double x) {
  return x - std::floor(x);
}

}  // namespace

SheetGlow::Grid::Grid(int samples, int across, int tall, int wide)
    : tall_(tall),
      wide_(wide),
      rows_((samples + tall - 1) / tall + 1),
      columns_((across + wide - 1) / wide + 1),
      cells_(static_cast<std::size_t>(rows_) * static_cast<std::size_t>(columns_)),
      most_(static_cast<std::size_t>(rows_)) {}

void SheetGlow::Grid::add(double sample, double place, double along, double across, double light) {
  const double row = sample / tall_, column = place / wide_;
  const double high = std::max(along / tall_, 1.0), broad = std::max(across / wide_, 1.0);
  const int top = static_cast<int>(std::ceil(row - high)), bottom = static_cast<int>(std::floor(row + high));
  const int left = static_cast<int>(std::ceil(column - broad)), right = static_cast<int>(std::floor(column + broad));
  const auto share = [](double off, double half) { return std::max(0.0, 1.0 - std::abs(off) / half); };
  double rows = 0.0, columns = 0.0;
  for (int r = top; r <= bottom; ++r) rows += share(r - row, high);
  shares_.clear();
  for (int c = left; c <= right; ++c) columns += shares_.emplace_back(share(c - column, broad));
  const double scale = light / (rows * columns * tall_ * wide_);
  for (int r = std::max(top, 0); r <= std::min(bottom, rows_ - 1); ++r) {
    float* const cells = &cells_[static_cast<std::size_t>(r) * static_cast<std::size_t>(columns_)];
    const double here = scale * share(r - row, high);
    float& most = most_[static_cast<std::size_t>(r)];
    for (int c = std::max(left, 0); c <= std::min(right, columns_ - 1); ++c) {
      cells[c] += static_cast<float>(here * shares_[static_cast<std::size_t>(c - left)]);
      most = std::max(most, cells[c]);
    }
  }
}

double SheetGlow::Grid::at(double sample, double place) const {
  const double row = sample / tall_, column = place / wide_;
  const int r = static_cast<int>(row), c = static_cast<int>(column);
  const double down = row - r, right = column - c;
  const float* const upper = &cells_[static_cast<std::size_t>(r) * static_cast<std::size_t>(columns_)];
  const float* const lower = down > 0.0 ? upper + columns_ : upper;
  const int next = right > 0.0 ? c + 1 : c;
  return (1.0 - down) * ((1.0 - right) * upper[c] + right * upper[next]) +
         down * ((1.0 - right) * lower[c] + right * lower[next]);
}

double SheetGlow::Grid::most(double sample) const {
  const auto row = static_cast<std::size_t>(sample / tall_);
  return std::max(most_[row], most_[std::min(row + 1, most_.size() - 1)]);
}

SheetGlow::SheetGlow(const Scenery& scenery, const Surfaces& surfaces, const Camera& camera)
    : scenery_(scenery),
      surfaces_(surfaces),
      camera_(camera),
      samples_(camera.upright ? camera.lens.height : camera.lens.width),
      across_(camera.upright ? camera.lens.width : camera.lens.height),
      fine_(samples_, across_, 4, 1),
      coarse_(samples_, across_, coarse_cell, coarse_cell) {}

/// Light that travels.
struct SheetGlow::Flight {
  SeenPoint from;
  Vec3 to_light;        ///< unit, back to where it came from
  double flux;          ///< as of a source
  double apart;         ///< m, between lines of spots
  double angle = 0.0;   ///< rad, width of the cone that a ray stands for
  double spread = 0.0;  ///< m, width of that cone
  Vec3 direction = Vec3::Zero();
};

/// Light that leaves each source as it came in.
std::vector<SheetGlow::Flight> SheetGlow::take_off(const Vec3& laser, const std::vector<Source>& sources,
                                                   std::size_t count, double shift) const {
  const double per_ray = static_cast<double>(sources.size()) / static_cast<double>(count);
  std::vector<Flight> flights(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Source& source = sources[static_cast<std::size_t>((static_cast<double>(i) + shift) * per_ray)];
    Flight& flight = flights[i];
    flight.from = source.point;
    flight.to_light = (laser - source.point.position).normalized();
    flight.flux = per_ray * source.flux;
    flight.apart = per_ray * source.apart;
  }
  return flights;
}

/// Draws from the surfaces' lobes where light goes on.
/// @param bounce  number of the surface that is met next, from 0
/// @param shift   of all draws
void SheetGlow::turn(std::vector<Flight>& flights, int bounce, const Eigen::Vector2d& shift) const {
  const unsigned base_u = bounce == 0 ? 2 : 5, base_v = bounce == 0 ? 3 : 7;
  for (std::size_t i = 0; i < flights.size(); ++i) {
    Flight& f = flights[i];
    Surface own;
    const Lobe lobe(surfaces_.at(f.from.line, f.from.label, f.from.position, own), f.from.normal, f.to_light);
    const Lobe::Sample sample =
        lobe.at(wrapped(shift.x() + reversed_digits(i, base_u)), wrapped(shift.y() + reversed_digits(i, base_v)));
    f.flux *= sample.factor;
    f.angle = 1.0 / std::sqrt(sample.density);
    f.direction = sample.direction;
  }
}

/// To the next surface; light that meets none is gone.
void SheetGlow::fly(std::vector<Flight>& flights) const {
  std::vector<Ray> rays(flights.size());
  std::vector<Hit> hits(flights.size());
  for (std::size_t i = 0; i < flights.size(); ++i) {
    const Flight& f = flights[i];
    rays[i] = ray_along(f.from.position, f.from.normal, f.direction);
  }
  scenery_.first_hits(rays.data(), hits.data(), rays.size(), Scenery::Rays::scattered);
  std::vector<Flight> arrived;
  for (std::size_t i = 0; i < flights.size(); ++i) {
    if (std::isnan(hits[i].distance) || !(flights[i].flux > 0.0)) continue;
    Flight f = flights[i];
    f.spread += hits[i].distance * f.angle;
    f.from = point_of(rays[i], hits[i]);
    f.to_light = -f.direction;
    arrived.push_back(f);
  }
  flights = std::move(arrived);
}

void SheetGlow::follow(const Pose& view, const Vec3& laser, const std::vector<Source>& sources, std::size_t count,
                       int bounces, Random key) {
  if (sources.empty()) return;
  std::vector<Flight> flights = take_off(laser, sources, count, key.uniform());
  for (int bounce = 0; bounce < bounces; ++bounce) {
    const double u = key.uniform(), v = key.uniform();
    turn(flights, bounce, {u, v});
    fly(flights);
    show(view, flights);
  }
}

/// Adds what the camera sees of spots.
void SheetGlow::show(const Pose& view, const std::vector<Flight>& flights) {
  struct Spot {
    double sample, across, along, wide, light;
  };
  const Pose back = view.inverse();
  std::vector<Spot> spots;
  std::vector<Ray> rays;
  for (const Flight& f : flights) {
    const Vec3 point = back * f.from.position;
    if (!(point.z() >= camera_.near && point.z() <= camera_.far)) continue;
    const auto pixel = camera_.lens.project(point);
    if (!pixel || !camera_.lens.inside(*pixel)) continue;
    const Vec3 to_eye = (view.position - f.from.position).normalized();
    const double in = f.from.normal.dot(f.to_light);
    Surface own;
    const Surface& surface = surfaces_.at(f.from.line, f.from.label, f.from.position, own);
    const double sent = reflected(surface, f.from.normal, f.to_light, to_eye);
    if (!(sent > 0.0)) continue;
    const double focal = camera_.upright ? camera_.lens.fx : camera_.lens.fy, size = point.z() / focal;
    const double facing = (view.orientation.conjugate() * f.from.normal).dot(point) / point.z();
    const double area = point.z() * point.z() / (camera_.lens.fx * camera_.lens.fy * std::abs(facing));
    // Some spots cover each place: those of one source, or, where they are far apart, of neighbouring ones.
    const double even = 2.0 * std::sqrt(f.spread * f.apart);
    const double wide = std::hypot(std::min(f.spread, even), camera_.sheet) / size;
    const double along = std::max(f.apart, even) / size;
    spots.push_back({camera_.upright ? pixel->y() : pixel->x(), camera_.upright ? pixel->x() : pixel->y(),
                     std::min(tent * along, widest), std::min(tent * std::hypot(wide, camera_.blur), widest),
                     f.flux * sent / in / area});
    rays.push_back(ray_between(f.from.position, f.from.normal, view.position));
  }
  std::vector<std::uint8_t> hidden(rays.size());
  scenery_.blocked(rays.data(), hidden.data(), rays.size(), Scenery::Rays::scattered);
  for (std::size_t i = 0; i < spots.size(); ++i) {
    const Spot& s = spots[i];
    if (hidden[i]) continue;
    const bool large = s.wide >= 2.0 * coarse_cell && s.along >= coarse_cell;
    (large ? coarse_ : fine_).add(s.sample, s.across, s.along, s.wide, s.light);
  }
}

double SheetGlow::at(int sample, int across) const {
  if (sample < 0 || sample >= samples_ || across < 0 || across >= across_) return 0.0;
  return fine_.at(sample, across) + coarse_.at(sample, across);
}

int SheetGlow::brightest(int sample, double least, const std::vector<std::pair<int, int>>& taken) const {
  if (fine_.most(sample) + coarse_.most(sample) < least) return -1;
  int best = -1;
  for (int a = 0; a < across_; ++a) {
    const auto in = [&](const std::pair<int, int>& range) { return a >= range.first && a <= range.second; };
    if (std::any_of(taken.begin(), taken.end(), in)) continue;
    const double here = at(sample, a);
    if (here < least) continue;
    least = here;
    best = a;
  }
  return best;
}

}  // namespace bin_scenes
