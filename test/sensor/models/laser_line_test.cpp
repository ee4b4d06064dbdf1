#include "sensor/models/laser_line.hpp"
#include "sensor/targets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace bin_scenes {
namespace {

/// A camera at the origin that looks along z, the laser at its right, turned towards the point (0, 0, 1).
LaserLine::Setup device(double baseline = 0.3) {
  LaserLine::Setup setup;
  setup.camera = Lens::from_fov(400, 300, 0.5);
  setup.laser_pose = {Vec3(baseline, 0, 0), Quat(Eigen::AngleAxisd(-std::atan(baseline), Vec3::UnitY()))};
  setup.near = 0.3;
  setup.far = 3.0;
  setup.profiles = 40;
  setup.scan = 2e-3 * Vec3::UnitX();
  return setup;
}

Targets plate(double z, double albedo = 0.6) {
  Targets targets;
  targets.add(box_target({4.0, 4.0, 0.02}), {Vec3(0, 0, z + 0.01), Quat::Identity()}, {albedo, 0.0, 0.4});
  return targets;
}

Profiles scan(Targets& targets, const LaserLine::Setup& setup, std::uint64_t seed = 1) {
  const Scenery scenery = targets.scenery();
  return LaserLine(scenery, targets.surfaces(), setup).scanned(Random(seed, 0, Stream::noise));
}

std::size_t count(const Profiles& profiles, Validity code) {
  return static_cast<std::size_t>(std::count(profiles.validity.begin(), profiles.validity.end(), code));
}

TEST(LaserLine, WithoutNoiseAPlaneIsExact) {
  LaserLine::Setup setup = device();
  setup.noise = false;
  setup.imager.bits = 16;
  for (const bool distorted : {false, true}) {
    if (distorted) setup.camera.distortion = {-0.1, 0.02, 0.001, -0.001, 0.0};
    Targets targets = plate(1.0);
    const Profiles p = scan(targets, setup);
    EXPECT_EQ(p.width, 300);
    EXPECT_EQ(p.height, 40);
    EXPECT_GT(count(p, Validity::valid), p.validity.size() * 95 / 100);
    for (std::size_t i = 0; i < p.points.size(); ++i) {
      if (p.validity[i] != Validity::valid) continue;
      ASSERT_NEAR(p.points[i][2], 1.0, 5e-5);
      // The sheet meets the plate at x = 0, and moves with the scan.
      ASSERT_NEAR(p.points[i][0], (static_cast<double>(i / 300) - 19.5) * 2e-3, 2e-5);
    }
  }
}

TEST(LaserLine, NoiseIsAsPredicted) {
  // A plate that falls along the scan: its line passes several columns of the camera.
  LaserLine::Setup setup = device();
  LaserLine::Setup quiet = setup;
  quiet.noise = false;
  for (const double albedo : {0.3, 0.9}) {
    Targets targets;
    const Quat turn(Eigen::AngleAxisd(0.3, Vec3::UnitY()));
    targets.add(box_target({4.0, 4.0, 0.02}), {Vec3(0, 0, 1.0) + turn * Vec3(0, 0, 0.01), turn}, {albedo, 0.0, 0.4});
    const Scenery scenery = targets.scenery();
    const LaserLine model(scenery, targets.surfaces(), setup);
    const Profiles noisy = model.scanned(Random(1, 0, Stream::noise));
    const Profiles exact = LaserLine(scenery, targets.surfaces(), quiet).scanned(Random(1, 0, Stream::noise));
    double square = 0.0;
    std::size_t n = 0;
    for (std::size_t i = 0; i < noisy.points.size(); ++i) {
      if (noisy.validity[i] != Validity::valid || std::abs(static_cast<int>(i % 300) - 150) > 60) continue;
      square += std::pow(noisy.points[i][2] - exact.points[i][2], 2);
      ++n;
    }
    ASSERT_GT(n, 4000u);
    EXPECT_NEAR(std::sqrt(square / static_cast<double>(n)) / model.depth_sigma(), 1.0, 0.05) << albedo;
  }
}

TEST(LaserLine, BehindAStepNeitherLaserNorCameraSees) {
  // A block 0.1 m high. The laser's shadow on the plate begins at the block's left edge and is h * tan(angle) wide;
  // over a scan it covers as many profiles as that is long.
  const double h = 0.1, half = 0.01;
  LaserLine::Setup setup = device(0.4);
  setup.noise = false;
  setup.profiles = 120;
  Targets targets = plate(1.0);
  targets.add(box_target({2 * half, 0.6, h}), {Vec3(0, 0, 1.0 - 0.5 * h), Quat::Identity()}, {0.6, 0.0, 0.4});
  const Profiles p = scan(targets, setup);
  std::size_t shadowed = 0, on_top = 0, other_side = 0;
  for (std::size_t k = 0; k < 120; ++k) {
    const std::size_t i = k * 300 + 150;
    if (p.validity[i] != Validity::valid) {
      shadowed += p.validity[i] == Validity::shadow;
      other_side += p.validity[i] != Validity::shadow;
    } else {
      on_top += std::abs(p.points[i][2] - 0.9) < 1e-3;
    }
  }
  EXPECT_EQ(other_side, 0u);
  EXPECT_NEAR(static_cast<double>(on_top), 2 * half / 2e-3, 1.5);  // the sheet is on the top for its length
  // Hidden: while the sheet goes down the block's right face, which the camera beside it may not see past the top. That
  // face is lit from the right; the camera stands between: it sees the face only while it is right of it.
  EXPECT_GT(shadowed, 0u);
}

/// Blocks of random height side by side along the line, so narrow that a ray of the fan often meets another one than
/// its neighbour does; gaps between some of them.
Targets staircase() {
  Targets targets;
  Random random(3, 0, Stream::probe);
  for (int i = 0; i < 60; ++i) {
    const double top = 1.0 - (i % 3 == 0 ? 0.0 : random.uniform(0.0, 0.02)), wide = random.uniform(0.004, 0.0065);
    targets.add(box_target({0.5, wide, 0.1}), {Vec3(0, -0.195 + 0.0065 * i, top + 0.05), Quat::Identity()},
                {0.6, 0.0, 0.4});
  }
  return targets;
}

TEST(LaserLine, EverySampleThatSeesTheLineHasAPoint) {
  LaserLine::Setup setup = device();
  setup.noise = false;
  setup.profiles = 1;
  Targets targets = staircase();
  const Profiles found = scan(targets, setup);
  // The same sheet by rays a hundred times as dense. Where two of them are on one face on both sides of a sample, the
  // line passes it; sides are left out, which light meets at a glancing angle.
  const int rays = 100 * 900;
  const double half = std::tan(0.5 * setup.settings.fan);
  std::vector<Ray> fan;
  for (int i = 0; i < rays; ++i) {
    const Vec3 way(0.0, half * (2.0 * i / (rays - 1) - 1.0), 1.0);
    fan.push_back({setup.laser_pose.position, setup.laser_pose.orientation * way, 1e-3, 10.0});
  }
  std::vector<Hit> hits(fan.size());
  const Scenery scenery = targets.scenery();
  scenery.first_hits(fan.data(), hits.data(), hits.size());
  std::vector<Ray> to_camera;
  std::vector<std::size_t> samples;
  double before = 0.0;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (std::isnan(hits[i].distance)) continue;
    const Vec3 point = fan[i].origin + hits[i].distance * fan[i].direction;
    const double here = setup.camera.project(point)->y();
    const bool same = i > 0 && hits[i - 1].label == hits[i].label && hits[i - 1].normal == hits[i].normal;
    if (same && std::floor(before) != std::floor(here) && hits[i].normal.z() < -0.9) {
      to_camera.push_back(ray_between(point, hits[i].normal, Vec3::Zero()));
      samples.push_back(static_cast<std::size_t>(std::lround(here)));
    }
    before = here;
  }
  std::vector<std::uint8_t> hidden(to_camera.size());
  scenery.blocked(to_camera.data(), hidden.data(), hidden.size());
  int seen = 0, missing = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (hidden[i] || samples[i] >= 300) continue;
    ++seen;
    const Validity code = found.validity[samples[i]];  // dark: a line that is hidden by a brighter one beside it
    missing += code != Validity::valid && code != Validity::dark;
  }
  EXPECT_GT(seen, 200);
  EXPECT_EQ(missing, 0);
}

TEST(LaserLine, TheBrighterOfTwoLinesInAColumnIsReported) {
  // A narrow bar in front of the plate, lit edge beside lit plate: where its sides are seen both lines lie in one
  // sample.
  LaserLine::Setup setup = device();
  setup.noise = false;
  Targets targets;
  targets.add(box_target({4.0, 4.0, 0.02}), {Vec3(0, 0, 1.01), Quat::Identity()}, {0.2, 0.0, 0.4});
  // A bar along x, turned about the camera's y: its front passes the sheet nearer than the plate, in the same samples.
  targets.add(box_target({0.6, 0.004, 0.004}), {Vec3(0, 0.05, 0.8), Quat::Identity()}, {0.9, 0.0, 0.4});
  const Profiles strongest = scan(targets, setup);
  setup.settings.peak = LaserLineSettings::Peak::nearest;
  const Profiles nearest = scan(targets, setup);
  std::size_t bar = 0;
  for (std::size_t i = 0; i < strongest.points.size(); ++i) {
    if (nearest.validity[i] == Validity::valid && nearest.points[i][2] < 0.9f) ++bar;
    if (strongest.validity[i] == Validity::valid && nearest.validity[i] == Validity::valid) {
      EXPECT_LE(nearest.points[i][2], strongest.points[i][2] + 1e-3f);
    }
  }
  EXPECT_GT(bar, 30u);
}

TEST(LaserLine, DarkAndMissingLines) {
  LaserLine::Setup setup = device();
  Targets black = plate(1.0, 0.01);
  EXPECT_GT(count(scan(black, setup), Validity::dark), 8000u);
  Targets nothing;
  nothing.add(box_target(Vec3(0.01, 0.01, 0.01)), {Vec3(0, 0, -1), Quat::Identity()});
  EXPECT_EQ(count(scan(nothing, setup), Validity::nothing), 12000u);
  setup.settings.fan = 0.2;
  Targets targets = plate(1.0);
  const Profiles p = scan(targets, setup);
  // At 1.04 m from the laser the sheet is 0.21 m long, the camera's rows 0.38 m.
  const double expected = 2.0 * std::tan(0.1) * std::hypot(1.0, 0.3) * setup.camera.fy;
  EXPECT_NEAR(static_cast<double>(count(p, Validity::valid)) / 40.0, expected, 2.0);
  EXPECT_GT(count(p, Validity::outside), 4000u);
}

/// Two faces at right angles that meet in a line along y at 0.75 m; the sheet runs along the left one, 6 mm from it. A
/// plate hides that line from the camera: what it sees is the light on the right face.
struct HiddenLine {
  static constexpr double apart = 0.006, depth = 0.75;
  LaserLine::Setup setup;
  Surface left, right;
  Vec3 lit = Vec3(0, 0, depth) + apart * along(-1);

  HiddenLine(const Surface& left, const Surface& right) : left(left), right(right) {
    setup.camera = Lens::from_fov(1200, 200, 0.3);
    setup.near = 0.3;
    setup.far = 3.0;
    setup.profiles = 1;
    setup.noise = false;
    setup.imager.bits = 16;
    const Vec3 laser(0.3, 0, 0);
    setup.laser_pose = {laser, Quat(Eigen::AngleAxisd(std::atan2(lit.x() - laser.x(), lit.z()), Vec3::UnitY()))};
    setup.indirect.bounces = 1;
  }
  static Vec3 along(int side) { return Vec3(side, 0.0, -1.0) / std::sqrt(2.0); }
  Targets targets() const {
    Targets targets;
    for (const int side : {-1, 1}) {
      Mesh face;
      for (const double far : {0.0, 0.06}) {
        for (const double y : {-0.2, 0.2}) face.vertices.push_back(Vec3(0, y, depth) + far * along(side));
      }
      face.triangles = {{0, 1, 2}, {1, 3, 2}};
      targets.add(face, Pose(), side < 0 ? left : right);
    }
    targets.add(box_target({0.06, 0.5, 0.001}), {Vec3(-0.031, 0, 0.6), Quat::Identity()}, {0.0, 0.0, 0.4});
    return targets;
  }
  double across(const Vec3& point) const { return setup.camera.project(point)->x(); }
  /// Of the sheet on a white surface that faces it: signal times width (m).
  double line() const {
    const double sigma = std::hypot(setup.settings.blur * lit.z() / setup.camera.fx, 0.25 * setup.line_width);
    return setup.settings.power * std::sqrt(2.0 * M_PI) * sigma;
  }
};

/// The line lights the other face with x d / 2 (x^2 + d^2)^1.5 of its light a metre, most at x = d / sqrt(2).
TEST(LaserLine, LightFromAMatteFaceIsAsInTheClosedForm) {
  HiddenLine scene({0.9, 0.0, 0.4}, {0.8, 0.0, 0.4});
  scene.setup.settings.power = 20.0;
  scene.setup.imager.reference_distance = (scene.lit - scene.setup.laser_pose.position).norm();
  scene.setup.indirect.samples = 8192;
  Targets targets = scene.targets();
  const Profiles p = scan(targets, scene.setup);
  const double d = HiddenLine::apart, x = d / std::sqrt(2.0), r = std::hypot(x, d);
  const double expected = scene.line() * 0.9 * 0.8 * x * d / (2.0 * r * r * r);
  const double at = scene.across(Vec3(0, 0, HiddenLine::depth) + x * HiddenLine::along(1));
  double intensity = 0.0, across = 0.0;
  for (std::size_t i = 30; i < 170; ++i) {
    ASSERT_EQ(p.validity[i], Validity::valid);
    EXPECT_EQ(p.label[i], 2);
    intensity += p.intensity[i] / 140.0;
    across += scene.across(Vec3(p.points[i][0], p.points[i][1], p.points[i][2])) / 140.0;
  }
  EXPECT_NEAR(intensity / expected, 1.0, 0.03);
  EXPECT_NEAR(across, at, 0.03 * (at - scene.across(Vec3(0, 0, HiddenLine::depth))));
}

/// A mirror throws the line onto the other face: the device takes it for the line, and errs by what its triangle says.
TEST(LaserLine, AMirrorMakesASecondLine) {
  HiddenLine scene({1.0, 1.0, 0.03}, {0.8, 0.0, 0.4});
  Targets targets = scene.targets();
  const Profiles p = scan(targets, scene.setup);
  const Vec3 normal = HiddenLine::along(1), way = (scene.lit - scene.setup.laser_pose.position).normalized();
  const Vec3 mirrored = way - 2.0 * normal.dot(way) * normal, other = HiddenLine::along(-1);
  const Vec3 met = scene.lit - other.dot(scene.lit - Vec3(0, 0, HiddenLine::depth)) / other.dot(mirrored) * mirrored;
  const double ray_at = scene.across(met);
  std::size_t seen = 0;
  for (std::size_t i = 30; i < 170; ++i) {
    ASSERT_EQ(p.validity[i], Validity::valid) << i;
    const Vec3 point(p.points[i][0], p.points[i][1], p.points[i][2]);
    EXPECT_NEAR(scene.across(point), ray_at, 0.7) << i;
    EXPECT_NEAR((scene.setup.laser_pose.inverse() * point).x(), 0.0, 1e-5);
    ++seen;
  }
  EXPECT_EQ(seen, 140u);
  scene.setup.indirect.bounces = 0;
  EXPECT_EQ(count(scan(targets, scene.setup), Validity::valid), 0u);
}

TEST(LaserLine, APlateThatNothingFacesIsUnchangedByBounces) {
  LaserLine::Setup setup = device();
  Targets targets = plate(1.0);
  const Profiles direct = scan(targets, setup);
  setup.indirect.bounces = 2;
  const Profiles twice = scan(targets, setup);
  EXPECT_EQ(direct.validity, twice.validity);
  EXPECT_EQ(direct.intensity, twice.intensity);
  EXPECT_EQ(0, std::memcmp(direct.points.data(), twice.points.data(), sizeof(direct.points[0]) * direct.points.size()));
}

TEST(LaserLine, SameSeedSameBits) {
  Targets targets = plate(1.0);
  const auto intensity = [&](std::uint64_t seed) { return scan(targets, device(), seed).intensity; };
  EXPECT_EQ(intensity(2), intensity(2));
  EXPECT_NE(intensity(2), intensity(3));
}

/// Beside each other a bright and a dark half: one exposure loses one of them, both together none. Each sample is that
/// of the exposure which serves it, bit for bit.
TEST(LaserLine, ExposuresAreMerged) {
  Targets targets;
  targets.add(box_target({4.0, 2.0, 0.02}), {Vec3(0, 1.0, 1.01), Quat::Identity()}, {0.9, 0.0, 0.4});
  targets.add(box_target({4.0, 2.0, 0.02}), {Vec3(0, -1.0, 1.01), Quat::Identity()}, {0.02, 0.0, 0.4});
  LaserLine::Setup setup = device();
  setup.noise = false;
  const auto with_power = [&](double power) {
    LaserLine::Setup one = setup;
    one.settings.power = power;
    return scan(targets, one);
  };
  const Profiles brief = with_power(0.5), lasting = with_power(8.0);
  setup.imager.exposures = {0.5, 8.0};
  setup.settings.power = 2.0;  // of the intensity alone
  const Profiles merged = scan(targets, setup);
  std::size_t as_brief = 0, as_lasting = 0;
  for (std::size_t i = 0; i < merged.points.size(); ++i) {
    const bool dark = lasting.validity[i] != Validity::saturated;
    const Profiles& own = dark ? lasting : brief;
    ASSERT_EQ(merged.validity[i], own.validity[i]);
    ASSERT_EQ(merged.snr[i], own.snr[i]);
    if (merged.validity[i] != Validity::valid) continue;
    ASSERT_EQ(merged.points[i], own.points[i]);
    ASSERT_NEAR(merged.intensity[i], std::min(own.intensity[i] * 2.0 / (dark ? 8.0 : 0.5), 1.0), 1e-5);
    ++(dark ? as_lasting : as_brief);
  }
  EXPECT_GT(as_brief, 3000u);
  EXPECT_GT(as_lasting, 3000u);
  EXPECT_GT(count(brief, Validity::dark), 3000u);
  EXPECT_GT(count(lasting, Validity::saturated), 3000u);
  setup.imager.exposures = {0.5};
  const Profiles one = scan(targets, setup);
  EXPECT_EQ(one.validity, brief.validity);
  for (std::size_t i = 0; i < one.points.size(); ++i) {
    if (one.validity[i] == Validity::valid) {
      ASSERT_EQ(one.points[i], brief.points[i]);
    }
  }
}

}  // namespace
}  // namespace bin_scenes
