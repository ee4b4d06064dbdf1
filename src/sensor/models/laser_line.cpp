/// Casts the sheet as a fan of rays for each step, projects what it hits into the camera, and finds the peak of the
/// line in every sample. Noise and speckle move the peak.
#include "sensor/models/laser_line.hpp"

#include "core/in_parallel.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace bin_scenes {

namespace {

void add_speckle(double contrast, Random& draw, std::vector<float>& window) {
  for (std::size_t i = 0; i < window.size(); i += 2) {
    double speckle[2];
    draw.normals(speckle[0], speckle[1]);
    for (std::size_t k = i; k < std::min(i + 2, window.size()); ++k) {
      window[k] *= static_cast<float>(std::max(0.0, 1.0 + contrast * speckle[k - i]));
    }
  }
}

}  // namespace

LaserLine::LaserLine(const Scenery& scenery, const Surfaces& surfaces, const Setup& setup, const Random& key)
    : scenery_(scenery), surfaces_(surfaces), setup_(setup), imager_(setup.imager, setup.noise), rays_(key) {
  to_camera_ = setup_.camera_pose.orientation.toRotationMatrix().transpose();
  sheet_ = setup_.laser_pose.orientation * Vec3::UnitX();
  const Vec3 seen = setup_.camera_pose.orientation.conjugate() * sheet_;
  upright_ = std::abs(seen.x()) >= std::abs(seen.y());
  samples_ = upright_ ? setup_.camera.height : setup_.camera.width;
  // Three rays of the fan for two samples of the camera, if it stands as far away as the laser.
  const double half = std::tan(0.5 * setup_.settings.fan);
  const int rays =
      std::max(2, static_cast<int>(std::ceil(3.0 * half * (upright_ ? setup_.camera.fy : setup_.camera.fx))));
  for (int i = 0; i < rays; ++i) {
    directions_.push_back(setup_.laser_pose.orientation * Vec3(0.0, half * (2.0 * i / (rays - 1) - 1.0), 1.0));
  }
  keep_what_the_camera_can_see();
  for (const double exposure : setup_.imager.exposures)
    scales_.insert(scales_.begin(), exposure / setup_.settings.power);
  if (scales_.empty()) scales_ = {1.0};
  reference_ = setup_.imager.reference_distance;
  if (!(reference_ > 0.0)) {
    std::vector<double> distances{1.0};
    for (const Hit& hit : fan(setup_.laser_pose.position)) {
      if (!std::isnan(hit.distance)) distances.push_back(hit.distance);
    }
    if (distances.size() > 1) distances.erase(distances.begin());
    const auto median = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
    std::nth_element(distances.begin(), median, distances.end());
    reference_ = *median;
  }
}

/// Cuts the fan's ends that pass the camera's image at every depth in range. A ray's points fall on a line of the
/// image, so that both of its ends on one side of the image are enough; a distorted line bends, and its fan stays
/// whole.
void LaserLine::keep_what_the_camera_can_see() {
  if (setup_.camera.distorts() || setup_.indirect.bounces > 0) return;  // light comes in from beside
  const Vec3 laser = to_camera_ * (setup_.laser_pose.position - setup_.camera_pose.position);
  /// -1: before the image's first sample, 1: behind its last one, 0: perhaps in it.
  const auto side = [&](const Vec3& direction) {
    const Vec3 ray = to_camera_ * direction;
    if (!(ray.z() > 0.0)) return 0;
    int sides[2];
    for (const int end : {0, 1}) {
      const double depth = std::max(end ? setup_.far : setup_.near, 1e-6), run = (depth - laser.z()) / ray.z();
      const auto pixel = run > 0.0 ? setup_.camera.project(laser + run * ray) : std::nullopt;
      if (!pixel) return 0;
      sides[end] = along(*pixel) < -1.0 ? -1 : along(*pixel) > samples_ ? 1 : 0;
    }
    return sides[0] == sides[1] ? sides[0] : 0;
  };
  std::size_t first = 0, last = directions_.size() - 1;
  while (first + 2 < last && side(directions_[first + 1]) && side(directions_[first + 1]) == side(directions_[first])) {
    ++first;
  }
  while (last > first + 2 && side(directions_[last - 1]) && side(directions_[last - 1]) == side(directions_[last])) {
    --last;
  }
  directions_ = {directions_.begin() + static_cast<std::ptrdiff_t>(first),
                 directions_.begin() + static_cast<std::ptrdiff_t>(last + 1)};
}

std::vector<Hit> LaserLine::fan(const Vec3& origin) const {
  std::vector<Ray> rays(directions_.size());
  for (std::size_t i = 0; i < rays.size(); ++i) rays[i] = {origin, directions_[i], 1e-3, 2.0 * setup_.far};
  std::vector<Hit> hits(rays.size());
  scenery_.first_hits(rays.data(), hits.data(), rays.size());
  return hits;
}

/// Standard deviation of a line in the image, pixels.
double LaserLine::sigma_at(double depth) const {
  const double focal = upright_ ? setup_.camera.fx : setup_.camera.fy;
  return std::hypot(setup_.settings.blur, 0.25 * setup_.line_width * focal / depth);
}

/// Standard deviation of one pixel's signal, speckle included.
double LaserLine::noise_of(double signal) const {
  return std::hypot(std::sqrt(imager_.variance(signal)), setup_.settings.speckle * signal);
}

std::optional<LaserLine::Reading> LaserLine::read(std::vector<float>& window, double sigma, Random& draw) const {
  if (setup_.noise && setup_.settings.speckle > 0.0) add_speckle(setup_.settings.speckle, draw, window);
  std::optional<Reading> longest;
  for (const double scale : scales_) {
    std::vector<float> exposed = window;
    for (float& signal : exposed) signal *= static_cast<float>(scale);
    imager_.expose(exposed.data(), exposed.size(), draw);
    const auto peak = find_line(exposed.data(), exposed.size(), sigma, setup_.settings.min_signal);
    if (!peak) break;  // a shorter one shows less
    longest = Reading{*peak, scale};
    if (!imager_.saturated(peak->height)) break;
  }
  return longest;
}

void LaserLine::read_lines(const Carriage& at, const Lines& seen, const SheetGlow* glow, Random draw, Profiles& out,
                           std::size_t profile) const {
  const Pose back = setup_.camera_pose.inverse();
  const std::size_t row = profile * static_cast<std::size_t>(samples_);
  std::copy(seen.codes.begin(), seen.codes.end(), out.validity.begin() + static_cast<std::ptrdiff_t>(row));
  const auto as_floats = [](const Vec3& v) {
    return std::array<float, 3>{static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
  };
  std::vector<float> window;
  for (auto first = seen.lines.begin(); first != seen.lines.end();) {
    const auto last = std::find_if(first, seen.lines.end(), [&](const auto& l) { return l.sample != first->sample; });
    const std::size_t pixel = row + static_cast<std::size_t>(first->sample);
    double best = -1.0;
    for (auto line = first; line != last; ++line) {
      if (!line->visible) continue;
      // A window of the image around this line, with the light of all of them.
      const double sigma = sigma_at(line->depth);
      const int reach = reach_of(sigma);
      const int begin = static_cast<int>(std::lround(line->across)) - reach;
      window.assign(static_cast<std::size_t>(2 * reach + 1), 0.0f);
      for (auto other = first; other != last; ++other) {
        if (!other->visible) continue;
        const double width = sigma_at(other->depth);
        for (std::size_t i = 0; i < window.size(); ++i) {
          const double x = (begin + static_cast<double>(i) - other->across) / width;
          window[i] += static_cast<float>(other->signal * std::exp(-0.5 * x * x));
        }
      }
      for (std::size_t i = 0; glow && i < window.size(); ++i) {
        window[i] += static_cast<float>(glow->at(line->sample, begin + static_cast<int>(i)));
      }
      const auto reading = read(window, sigma, draw);
      if (!reading) {
        if (best < 0.0 && line->signal > 0.0) out.validity[pixel] = Validity::dark;
        continue;
      }
      const LinePeak& peak = reading->peak;
      const double b = begin + peak.row, height = peak.height / reading->scale;
      const Vec3 ray = upright_ ? setup_.camera.ray(b, line->sample) : setup_.camera.ray(line->sample, b);
      const Vec3 direction = setup_.camera_pose.orientation * ray;
      const double z = sheet_.dot(at.laser - at.eye) / sheet_.dot(direction);
      const double rank = setup_.settings.peak == LaserLineSettings::Peak::strongest ? height : 1.0 / z;
      if (rank <= best) continue;
      best = rank;
      out.intensity[pixel] = static_cast<float>(std::min(height, 1.0));
      out.snr[pixel] = static_cast<float>(peak.height / noise_of(peak.height));
      out.label[pixel] = line->label;
      out.normals[pixel] = as_floats(back.orientation * line->normal);
      out.points[pixel] = as_floats(Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
      if (imager_.saturated(peak.height)) {
        out.validity[pixel] = Validity::saturated;
      } else if (!(z >= setup_.near && z <= setup_.far)) {
        out.validity[pixel] = Validity::decoding;
      } else {
        out.validity[pixel] = Validity::valid;
        out.points[pixel] = as_floats(back * (at.eye + z * direction));
      }
    }
    first = last;
  }
}

double LaserLine::depth_sigma() const {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr int draws = 4000;  // know a standard deviation within 1 %
  Lines lines;
  const Carriage at = carriage(Vec3::Zero());
  find_lines(at, fan(at.laser), lines);
  for (const Line& line : lines.lines) {
    if (line.sample != samples_ / 2 || !line.visible || line.signal * scales_.front() < setup_.settings.min_signal)
      continue;
    const double sigma = sigma_at(line.depth);
    const int reach = reach_of(sigma);
    Random draw(0, 0, Stream::probe);
    std::vector<float> window(static_cast<std::size_t>(2 * reach + 1));
    double square = 0.0;
    int found = 0;
    for (int k = 0; k < draws; ++k) {
      const double across = reach + (k + 0.5) / draws - 0.5;
      for (std::size_t i = 0; i < window.size(); ++i) {
        const double x = (static_cast<double>(i) - across) / sigma;
        window[i] = static_cast<float>(line.signal * std::exp(-0.5 * x * x));
      }
      const auto reading = read(window, sigma, draw);
      if (!reading) continue;
      square += (reading->peak.row - across) * (reading->peak.row - across);
      ++found;
    }
    if (found < draws / 2) return nan;
    const double row = std::sqrt(square / found);
    const auto depth = [&](double across) {
      const Vec3 ray = upright_ ? setup_.camera.ray(across, line.sample) : setup_.camera.ray(line.sample, across);
      return sheet_.dot(setup_.laser_pose.position - setup_.camera_pose.position) /
             sheet_.dot(setup_.camera_pose.orientation * ray);
    };
    return row * 0.5 * std::abs(depth(line.across + 1.0) - depth(line.across - 1.0));
  }
  return nan;
}

Profiles LaserLine::scanned(const Random& random) const {
  Profiles out;
  out.width = samples_;
  out.height = setup_.profiles;
  const std::size_t pixels = static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height);
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  out.validity.assign(pixels, Validity::nothing);
  out.points.assign(pixels, {nan, nan, nan});
  out.normals = out.points;
  out.label.assign(pixels, 0);
  out.intensity.assign(pixels, 0.0f);
  out.snr.assign(pixels, 0.0f);
  in_parallel(static_cast<std::size_t>(out.height), [&](std::size_t profile) {
    const Vec3 offset = (static_cast<double>(profile) - 0.5 * (out.height - 1)) * setup_.scan;
    const Carriage at = carriage(offset);
    const std::vector<Hit> hits = fan(at.laser);
    Lines lines;
    find_lines(at, hits, lines);
    std::optional<SheetGlow> glow;
    if (setup_.indirect.bounces > 0) {
      glow.emplace(scenery_, surfaces_, glow_camera());
      follow(at, hits, rays_.of_piece(profile), *glow);
      add_second_lines(at, *glow, lines.lines);
    }
    read_lines(at, lines, glow ? &*glow : nullptr, random.of_piece(profile), out, profile);
  });
  return out;
}

}  // namespace bin_scenes
