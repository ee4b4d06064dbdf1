#include "sensor/models/time_of_flight.hpp"
#include "sensor/shot.hpp"
#include "sensor/targets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstring>
#include <utility>
#include <vector>

namespace bin_scenes {
namespace {

constexpr double speed_of_light = 299792458.0;  // m/s

/// Two matte faces at right angles that meet in a line along y, wholly seen and lit.
struct Groove {
  static constexpr double width = 0.2, length = 0.5, depth = 1.0;
  double albedo = 0.8;
  TimeOfFlightSetup setup;
  Lens camera = Lens::from_fov(72, 120, 0.36);

  Groove() {
    setup.noise = false;
    setup.near = 0.1;
    setup.far = 5.0;
    setup.indirect.bounces = 1;
    setup.settings.min_signal = 1e-6;
  }
  Targets targets() const { return test::groove({albedo, 0.0, 0.4}, depth, width, length); }
  /// Along a face, away from the line.
  static Vec3 along(int side) { return Vec3(side, 0.0, -1.0) / std::sqrt(2.0); }

  /// Light of the other face over direct light at a point, its phase that of the longer way.
  std::complex<double> ratio(const Vec3& point) const {
    constexpr int slices = 200, turns = 100;
    const int side = point.x() > 0.0 ? 1 : -1;
    const Vec3 normal = along(-side), other_normal = along(side);
    const double x = (point - Vec3(0, 0, depth)).dot(along(side)), widest = std::atan(width / x);
    const double wave = 2.0 * M_PI * 1e6 * setup.settings.modulation / speed_of_light;
    const double direct = -normal.dot(point.normalized()) / point.squaredNorm();
    std::complex<double> sum;
    for (int i = 0; i < slices; ++i) {
      const double angle = (i + 0.5) / slices * widest, s = x * std::tan(angle), gap = std::hypot(x, s);
      const double ds = x / (std::cos(angle) * std::cos(angle)) * widest / slices;
      const double low = std::atan((-0.5 * length - point.y()) / gap),
                   high = std::atan((0.5 * length - point.y()) / gap);
      for (int k = 0; k < turns; ++k) {
        const double lean = low + (k + 0.5) / turns * (high - low);
        const double dy = gap / (std::cos(lean) * std::cos(lean)) * (high - low) / turns;
        const Vec3 from = Vec3(0, 0, depth) + s * along(-side) + (point.y() + gap * std::tan(lean)) * Vec3::UnitY();
        const Vec3 way = from - point;
        const double r2 = way.squaredNorm(), lit = -other_normal.dot(from.normalized()) / from.squaredNorm();
        const double taken = normal.dot(way) * -other_normal.dot(way) / (M_PI * r2 * r2) * ds * dy;
        sum += std::polar(albedo * lit * taken / direct, wave * (from.norm() + way.norm() - point.norm()));
      }
    }
    return sum;
  }
  /// By how much that moves depth (m): half the way that the sum's phase tells.
  double shift(const Vec3& point) const {
    const double way = std::arg(1.0 + ratio(point)) * speed_of_light / (2e6 * M_PI * setup.settings.modulation);
    return 0.5 * way * point.z() / point.norm();
  }
};

struct Shot {
  View view;
  Measurement measured;
};

Shot shoot(Targets& targets, const Lens& camera, const TimeOfFlightSetup& setup) {
  const Scenery scenery = targets.scenery();
  Shot shot{render(scenery, camera, Pose(), setup.near, setup.far), Measurement(0)};
  shot.measured = time_of_flight(scenery, shot.view, targets.surfaces(), setup, Random(1, 0, Stream::noise));
  return shot;
}

/// Pixels that see one face alone.
std::vector<std::size_t> on_one_face(const View& view) {
  std::vector<std::size_t> found;
  const auto width = static_cast<std::size_t>(view.lens.width);
  for (std::size_t i = width + 1; i + width + 1 < view.depth.size(); ++i) {
    bool one = true;
    for (const std::size_t k : {i - width - 1, i - width + 1, i + width - 1, i + width + 1})
      one = one && !std::isnan(view.depth[k]) && view.normal[k] == view.normal[i];
    if (one && !std::isnan(view.depth[i])) found.push_back(i);
  }
  return found;
}

struct Errors {
  double largest = 0.0, smallest = 1e9, rms = 0.0;  ///< of depth (m)
  double expected = 0.0, expected_rms = 0.0;        ///< largest that the integration gives, and rms
  double off = 0.0;                                 ///< largest difference from it
};

Errors errors_in(const Groove& groove) {
  Targets targets = groove.targets();
  const Shot shot = shoot(targets, groove.camera, groove.setup);
  Errors out;
  const auto width = static_cast<std::size_t>(groove.camera.width);
  int count = 0;
  for (const std::size_t i : on_one_face(shot.view)) {
    EXPECT_EQ(shot.measured.validity[i], Validity::valid) << i;
    const double error = shot.measured.depth[i] - shot.view.depth[i];
    out.largest = std::max(out.largest, error);
    out.smallest = std::min(out.smallest, error);
    if (i / width % 29 != 0) continue;  // the integration is slow
    const Vec3 ray = groove.camera.ray(static_cast<double>(i % width), static_cast<double>(i / width));
    const double expected = groove.shift(shot.view.depth[i] * ray);
    out.expected = std::max(out.expected, expected);
    out.off = std::max(out.off, std::abs(error - expected));
    out.expected_rms += expected * expected;
    out.rms += error * error;
    ++count;
  }
  EXPECT_GT(count, 150);
  out.rms = std::sqrt(out.rms / count);
  out.expected_rms = std::sqrt(out.expected_rms / count);
  return out;
}

TEST(Multipath, GrooveErrsAsIntegrated) {
  for (const auto& [modulation, millimetres] : {std::pair{20.0, 14.8}, std::pair{200.0, 13.9}}) {
    Groove groove;
    groove.setup.settings.modulation = modulation;
    groove.setup.indirect.samples = 4096;
    const Errors e = errors_in(groove);
    EXPECT_NEAR(1e3 * e.expected, millimetres, 0.05);
    EXPECT_LT(e.off, 0.03 * e.expected) << modulation;
  }
}

/// Light by way of the other face goes a longer way: a corner is always measured too far.
TEST(Multipath, FewRaysFindTheErrorInTheMean) {
  const Errors e = errors_in(Groove());
  EXPECT_NEAR(e.rms / e.expected_rms, 1.0, 0.03);
  EXPECT_GT(e.smallest, 0.0);
}

/// What met two faces has albedo squared, what met one has albedo: where both are of one phase, as of slow modulation,
/// their ratio moves depth.
TEST(Multipath, ErrorGrowsWithAlbedo) {
  Groove bright, dark;
  bright.setup.settings.modulation = dark.setup.settings.modulation = 1.0;
  bright.albedo = 0.1;
  dark.albedo = 0.05;
  EXPECT_NEAR(errors_in(dark).rms / errors_in(bright).rms, 0.5, 0.01);
}

/// Share of the light of a rectangle that reaches the other one across a common edge, at right angles (Hottel). In
/// edges.
double form_factor(double width) {
  const double w2 = width * width, both = std::sqrt(2.0) * width;
  const double edge =
      std::log(std::pow(1.0 + w2, 2) / (1.0 + 2.0 * w2)) + 2.0 * w2 * std::log((1.0 + 2.0 * w2) / (2.0 * (1.0 + w2)));
  return (2.0 * width * std::atan(1.0 / width) - both * std::atan(1.0 / both) + 0.25 * edge) / (M_PI * width);
}

/// Of what the faces send, no more is added than reaches the other face, times albedo. At the line, where most of it
/// is, pixels see both faces and are left out.
TEST(Multipath, AddsNoMoreLightThanTheFacesSend) {
  Groove groove;
  groove.albedo = 0.5;
  groove.setup.settings.modulation = 0.1;  // all of one phase: amplitudes are light
  Targets targets = groove.targets();
  double light[2] = {0.0, 0.0};
  for (const int bounces : {0, 1}) {
    groove.setup.indirect.bounces = bounces;
    const Shot shot = shoot(targets, groove.camera, groove.setup);
    for (const std::size_t i : on_one_face(shot.view)) {
      const Vec3 ray = groove.camera.ray(static_cast<double>(i % 72), static_cast<double>(i / 72));
      const auto& n = shot.view.normal[i];
      const double z2 = shot.view.depth[i] * shot.view.depth[i];
      const double area = z2 / (groove.camera.fx * groove.camera.fy) / std::abs(Vec3(n[0], n[1], n[2]).dot(ray));
      ASSERT_LT(shot.measured.intensity[i], 1.0f);
      light[bounces] += shot.measured.intensity[i] / ray.squaredNorm() * area;
    }
  }
  const double passed = form_factor(Groove::width / Groove::length), added = light[1] / light[0] - 1.0;
  EXPECT_LT(added, groove.albedo * passed);
  EXPECT_GT(added, 0.85 * groove.albedo * passed);
}

TEST(Multipath, APlateThatNothingFacesIsUnchanged) {
  Groove groove;
  groove.setup.noise = true;
  Targets targets;
  targets.add(box_target({0.5, 0.5, 0.02}), {Vec3(0, 0, 0.76), Quat(Eigen::AngleAxisd(0.3, Vec3::UnitY()))},
              {0.8, 0.4, 0.3});
  groove.setup.indirect.bounces = 0;
  const Shot none = shoot(targets, groove.camera, groove.setup);
  groove.setup.indirect.bounces = 2;
  const Shot two = shoot(targets, groove.camera, groove.setup);
  EXPECT_EQ(none.measured.validity, two.measured.validity);
  EXPECT_EQ(none.measured.intensity, two.measured.intensity);
  EXPECT_EQ(none.measured.snr, two.measured.snr);
  EXPECT_EQ(0, std::memcmp(none.measured.depth.data(), two.measured.depth.data(), 8 * none.view.depth.size()));
}

/// Noise is that of all light that comes back, and SNR tells it.
TEST(Multipath, NoiseFollowsTheSum) {
  Groove groove;
  groove.setup.settings.lateral = groove.setup.settings.lateral_angle = 0.0;
  Targets targets = groove.targets();
  const Shot quiet = shoot(targets, groove.camera, groove.setup);
  groove.setup.noise = true;
  const Shot noisy = shoot(targets, groove.camera, groove.setup);
  groove.setup.indirect.bounces = 0;
  const Shot direct = shoot(targets, groove.camera, groove.setup);
  double square = 0.0;
  const std::vector<std::size_t> pixels = on_one_face(quiet.view);
  for (const std::size_t i : pixels) {
    const double sigma = quiet.measured.depth[i] / noisy.measured.snr[i];
    square += std::pow((noisy.measured.depth[i] - quiet.measured.depth[i]) / sigma, 2);
    EXPECT_GT(noisy.measured.snr[i], direct.measured.snr[i]) << i;
  }
  EXPECT_NEAR(std::sqrt(square / static_cast<double>(pixels.size())), 1.0, 0.03);
}

/// What a groove's second bounce adds is less than the first one's, and comes later still.
TEST(Multipath, ASecondBounceAddsLess) {
  Groove groove;
  double rms[3];
  for (const int bounces : {0, 1, 2}) {
    groove.setup.indirect.bounces = bounces;
    rms[bounces] = errors_in(groove).rms;
  }
  EXPECT_LT(rms[0], 1e-9);
  EXPECT_GT(rms[2], 1.02 * rms[1]);
  EXPECT_LT(rms[2], 1.5 * rms[1]);
}

}  // namespace
}  // namespace bin_scenes
