#include "light/interreflection.hpp"
#include "light/facets.hpp"
#include "sensor/models/structured_light.hpp"
#include "sensor/shot.hpp"
#include "sensor/targets.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <cstring>
#include <vector>

namespace bin_scenes {
namespace {

/// The same light on every surface, as if all of them shone.
class EvenLamp : public Lamp {
 public:
  void light(const SeenPoint* points, const Vec3*, Lit* lit, std::size_t count) const override {
    for (std::size_t i = 0; i < count; ++i) {
      lit[i] = {};
      if (points[i].hit) lit[i] = {Validity::valid, 0.0, 0.0, 1.0, 1.0};
    }
  }
  Vec3 slope(const Vec3&, double) const override { return Vec3::Zero(); }
  Vec3 direction_at(const Vec3&) const override { return Vec3::Zero(); }
};

/// A box seen from within.
Targets furnace(const Surface& surface) {
  Mesh box = box_target({0.3, 0.2, 0.1});
  for (Triangle& t : box.triangles) std::swap(t[1], t[2]);
  Targets targets;
  targets.add(box, Pose(), surface);
  return targets;
}

const Vec3 eye(-0.05, 0.02, -0.04);
const std::vector<Vec3> places = {{0.02, 0.03, 0.05}, {0.14, 0.09, 0.05}, {-0.1, 0.0, 0.05}};

double gathered(Targets& targets, int samples, int bounces) {
  const Scenery scenery = targets.scenery();
  Gathered light;
  double sum = 0.0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const SeenPoint point{places[i], -Vec3::UnitZ(), 0, true};
    gather({scenery, targets.surfaces(), EvenLamp()}, point, eye, {samples, bounces}, Random(1, i, Stream::sensor),
           light);
    for (const Path& path : light.paths) sum += path.weight / static_cast<double>(places.size());
  }
  return sum;
}

/// Each bounce adds as much as the surfaces shine, times albedo once more.
TEST(Interreflection, WhiteFurnace) {
  for (const double albedo : {1.0, 0.5}) {
    Targets matte = furnace({albedo, 0.0, 0.4});
    EXPECT_NEAR(gathered(matte, 32, 1), albedo, 0.01 * albedo);
    EXPECT_NEAR(gathered(matte, 32, 2), albedo + albedo * albedo, 0.01 * albedo);
  }
  for (const double roughness : {0.2, 0.5, 1.0}) {
    Targets shiny = furnace({1.0, 1.0, roughness});
    EXPECT_NEAR(gathered(shiny, 4096, 1), 1.0, 0.01) << roughness;
    EXPECT_NEAR(gathered(shiny, 4096, 2), 2.0, 0.02) << roughness;
  }
  // Light from everywhere that a smooth metal takes once: what Fresnel leaves at the angles of sight.
  Targets metal = furnace({1.0, 1.0, 0.2, 2.9114, 3.0893});
  double left = 0.0;
  for (const Vec3& place : places) left += fresnel(-(eye - place).normalized().z(), 2.9114, 3.0893) / 3.0;
  EXPECT_NEAR(gathered(metal, 4096, 1), left, 0.01);
  EXPECT_NEAR(gathered(metal, 4096, 2), left + left * left, 0.05);
}

/// Reflectance as a test of its own has it: a matte share and facets distributed by GGX, shadowed as Smith says, with
/// heights correlated, and what meets several facets by Kulla and Conty. Times pi and the cosine of the light.
class Reflectance {
 public:
  explicit Reflectance(const Surface& surface)
      : surface_(surface), alpha2_(std::pow(std::max(surface.roughness * surface.roughness, 1e-3), 2)) {
    if (surface.gloss <= 0.0) return;
    for (int i = 0; i <= steps; ++i) once_.push_back(sent_once(std::max(1e-3, i / static_cast<double>(steps))));
    for (int i = 0; i < 1000; ++i) mean_ += once((i + 0.5) / 1000) * 2.0 * (i + 0.5) / 1000 / 1000;
  }
  double operator()(const Vec3& normal, const Vec3& to_light, const Vec3& to_eye) const {
    const double in = normal.dot(to_light), out = normal.dot(to_eye),
                 half = normal.dot((to_light + to_eye).normalized());
    const double matte = (1.0 - surface_.gloss) * surface_.albedo * in;
    if (surface_.gloss <= 0.0) return matte;
    const double again = (1.0 - once(in)) * (1.0 - once(out)) / (1.0 - mean_);
    return matte + surface_.gloss * surface_.albedo * (M_PI * facets(in, out, half) + again) * in;
  }

 private:
  static constexpr int steps = 64;
  double facets(double in, double out, double half) const {
    const auto slope = [&](double c) { return std::sqrt(1.0 + alpha2_ * (1.0 / (c * c) - 1.0)); };
    const double density = alpha2_ / (M_PI * std::pow(half * half * (alpha2_ - 1.0) + 1.0, 2));
    return density * 2.0 / (slope(in) + slope(out)) / (4.0 * in * out);
  }
  double sent_once(double in) const {
    constexpr int fine = 200;
    const Vec3 light(std::sqrt(1.0 - in * in), 0.0, in);
    double sum = 0.0;
    for (int i = 0; i < fine; ++i) {
      for (int k = 0; k < fine; ++k) {
        const double out = (i + 0.5) / fine, turn = 2.0 * M_PI * (k + 0.5) / fine, wide = std::sqrt(1.0 - out * out);
        const Vec3 eye(wide * std::cos(turn), wide * std::sin(turn), out);
        sum += facets(in, out, (light + eye).normalized().z()) * out * 2.0 * M_PI / (fine * fine);
      }
    }
    return sum;
  }
  double once(double cosine) const {
    const double at = std::min(cosine, 1.0) * steps;
    const int i = std::min(static_cast<int>(at), steps - 1);
    return once_[i] + (at - i) * (once_[i + 1] - once_[i]);
  }
  Surface surface_;
  double alpha2_, mean_ = 0.0;
  std::vector<double> once_;
};

/// Two faces at right angles, 57 mm wide, that meet in a line along y at 0.75 m.
struct Groove {
  static constexpr double width = 0.057, length = 0.6, depth = 0.75;
  Surface surface;
  StructuredLight::Setup setup;
  Reflectance reflectance;
  Lens camera = Lens::from_fov(200, 24, 0.112);

  Groove(double albedo, double period) : Groove(Surface{albedo, 0.0, 0.4}, period) {}
  Groove(const Surface& surface, double period) : surface(surface), reflectance(surface) {
    setup.projector = Lens::from_fov(1280, 800, 1.0);
    setup.projector_pose = {Vec3(0.1112, 0.0, 0.0), Quat(Eigen::AngleAxisd(-std::atan(0.1112 / depth), Vec3::UnitY()))};
    setup.settings.period = period;
    setup.settings.min_modulation = 1e-6;
    setup.noise = false;
    setup.near = 0.1;
    setup.far = 2.0;
    setup.indirect.bounces = 1;
  }
  /// Along a face, away from the line.
  static Vec3 along(int side) { return Vec3(side, 0.0, -1.0) / std::sqrt(2.0); }
  Targets targets() const { return test::groove(surface, depth, width, length); }
  double column(const Vec3& point) const {
    return setup.projector.project(setup.projector_pose.inverse() * point)->x();
  }
  /// Light of the projector's white that a point of a face sends to a place.
  double white(const Vec3& point, const Vec3& normal, const Vec3& to) const {
    const Vec3 way = setup.projector_pose.position - point;
    return reflectance(normal, way.normalized(), (to - point).normalized()) / way.squaredNorm();
  }
  /// By how much the light of the other face moves what is read at a point of a face.
  struct Shift {
    double columns;
    double left;  ///< amplitude of the fringe / that of direct light
  };
  Shift shift(const Vec3& point) const {
    const int slices = 200, turns = surface.gloss > 0.0 ? 150 : 50;
    const int side = point.x() > 0.0 ? 1 : -1;
    const Vec3 normal = along(-side), other_normal = along(side);
    const double x = (point - Vec3(0, 0, depth)).dot(along(side)), widest = std::atan(width / x);
    const double turn = 2.0 * M_PI / setup.settings.period;
    std::complex<double> sum;
    for (int i = 0; i < slices; ++i) {
      const double angle = (i + 0.5) / slices * widest, s = x * std::tan(angle);
      const double ds = x / (std::cos(angle) * std::cos(angle)) * widest / slices;
      const double gap = std::hypot(x, s);
      for (int k = 0; k < turns; ++k) {
        const double low = std::atan((-0.5 * length - point.y()) / gap),
                     high = std::atan((0.5 * length - point.y()) / gap);
        const double lean = low + (k + 0.5) / turns * (high - low);
        const double dy = gap / (std::cos(lean) * std::cos(lean)) * (high - low) / turns;
        const Vec3 from = Vec3(0, 0, depth) + s * along(-side) + (point.y() + gap * std::tan(lean)) * Vec3::UnitY();
        const Vec3 way = from - point;
        const double r2 = way.squaredNorm();
        const double factor = -other_normal.dot(way.normalized()) / (M_PI * r2) * ds * dy;
        sum += reflectance(normal, way.normalized(), -point.normalized()) * factor * white(from, other_normal, point) *
               std::polar(1.0, turn * column(from));
      }
    }
    const std::complex<double> direct = std::polar(white(point, normal, Vec3::Zero()), turn * column(point));
    return {std::arg((direct + sum) / direct) / turn, std::abs((direct + sum) / direct)};
  }
};

struct Errors {
  double expected = 0.0;  ///< largest that the integration gives
  double off = 0.0;       ///< largest difference of what was measured
  double expected_rms = 0.0, measured_rms = 0.0, off_rms = 0.0;
};

/// Columns within a period; every pixel of a row. Where both lights nearly cancel, the sum tells little: of a shiny
/// groove such pixels, and those whose Gray code makes no sense, are left out.
Errors errors_in(const Groove& groove, bool decoded) {
  const bool shiny = groove.surface.gloss > 0.0;

  Targets targets = groove.targets();
  const auto [view, measured, sigma] = test::shoot<StructuredLight>(targets, groove.camera, groove.setup, decoded);
  Errors out;
  int count = 0;
  for (const int row : {5}) {
    for (int x = 2; x < groove.camera.width - 2; ++x) {
      const std::size_t i = static_cast<std::size_t>(row * groove.camera.width + x);
      const Vec3 ray = groove.camera.ray(x, row), point = view.depth[i] * ray;
      const double from_line = (point - Vec3(0, 0, Groove::depth)).head<3>().cwiseAbs().maxCoeff();
      if (std::isnan(view.depth[i]) || std::abs(point.x()) < 0.0008 || from_line > 0.0395) continue;
      if (measured.validity[i] != Validity::valid) {
        if (shiny) continue;
        ADD_FAILURE() << "pixel " << x << " " << row << " has code " << int(measured.validity[i]);
        continue;
      }
      const Groove::Shift shift = groove.shift(point);
      if (shiny && shift.left < 0.5) continue;
      const double period = groove.setup.settings.period, expected = shift.columns;
      const double seen = std::remainder(groove.column(measured.depth[i] * ray) - groove.column(point), period);
      const double off = std::remainder(seen - expected, period);
      out.expected = std::max(out.expected, std::abs(expected));
      out.off = std::max(out.off, std::abs(off));
      out.expected_rms += expected * expected;
      out.measured_rms += seen * seen;
      out.off_rms += off * off;
      ++count;
    }
  }
  EXPECT_GT(count, shiny ? 60 : 120);
  out.expected_rms = std::sqrt(out.expected_rms / count);
  out.measured_rms = std::sqrt(out.measured_rms / count);
  out.off_rms = std::sqrt(out.off_rms / count);
  return out;
}

TEST(Interreflection, GrooveErrsAsIntegrated) {
  for (const bool decoded : {false, true}) {
    Groove groove(0.9, 64.0);
    groove.setup.indirect.samples = 1024;
    const Errors e = errors_in(groove, decoded);
    EXPECT_GT(e.expected, 2.0);
    EXPECT_LT(e.off, 0.03 * e.expected) << decoded;
  }
}

/// Shiny faces throw light back to where it comes from, by way of each other: more than they send to the camera
/// directly. Columns at points of a row; where both lights nearly cancel, their sum tells little.
TEST(Interreflection, ShinyGrooveErrsAsIntegrated) {
  for (const Surface& surface : {Surface{0.8, 0.7, 0.4}, Surface{0.8, 0.9, 0.3}}) {
    const Groove groove(surface, 16.0);
    Targets targets = groove.targets();
    const Scenery scenery = targets.scenery();
    const ProjectorLamp lamp(scenery, groove.setup.projector, groove.setup.projector_pose, targets.surfaces());
    const double turn = 2.0 * M_PI / groove.setup.settings.period;
    double largest = 0.0, off = 0.0;
    int count = 0;
    for (int i = -40; i <= 40; ++i) {
      const int side = i < 0 ? -1 : 1;
      const Vec3 point = Vec3(0, 0, Groove::depth) + (0.0012 + 0.0013 * std::abs(i)) * Groove::along(side);
      const SeenPoint seen{point, Groove::along(-side), 0, true};
      const Groove::Shift expected = groove.shift(point);
      if (expected.left < 0.5) continue;
      Gathered light;
      gather({scenery, targets.surfaces(), lamp}, seen, Vec3::Zero(), {4096, 1},
             Random(1, static_cast<std::uint64_t>(i + 40), Stream::sensor), light);
      const std::complex<double> direct =
          std::polar(groove.white(point, seen.normal, Vec3::Zero()), turn * groove.column(point));
      std::complex<double> sum = direct;
      for (const Path& path : light.paths) sum += std::polar(path.weight, turn * path.column);
      const double columns = std::arg(sum / direct) / turn;
      largest = std::max(largest, std::abs(expected.columns));
      off = std::max(off, std::abs(std::remainder(columns - expected.columns, groove.setup.settings.period)));
      ++count;
    }
    EXPECT_GT(count, 60);
    EXPECT_GT(largest, 4.0) << surface.gloss;
    EXPECT_LT(off, 0.03 * largest) << surface.gloss;
  }
}

/// Between nodes, that light is less exact: by a tenth of its errors.
TEST(Interreflection, ShinyFacesAreInterpolated) {
  Groove groove(Surface{0.8, 0.7, 0.4}, 16.0);
  groove.setup.indirect.samples = 1024;
  const Errors e = errors_in(groove, false);
  EXPECT_NEAR(e.measured_rms / e.expected_rms, 1.0, 0.05);
  EXPECT_LT(e.off_rms, 0.1 * e.expected_rms);
}

/// As many rays as by default: what they leave is less than what they tell.
TEST(Interreflection, FewRaysFindTheErrorInTheMean) {
  const Errors e = errors_in(Groove(0.9, 64.0), false);
  EXPECT_NEAR(e.measured_rms / e.expected_rms, 1.0, 0.1);
  EXPECT_LT(e.off_rms, 0.3 * e.expected_rms);
}

/// The default gives places with much indirect light more rays, until their noise is a tenth of the error.
TEST(Interreflection, TheDefaultFindsTheErrorOfAGrooveToATenth) {
  for (const double period : {24.0, 64.0}) {
    const Errors e = errors_in(Groove(0.9, period), false);
    EXPECT_LT(e.off_rms, 0.1 * e.expected_rms) << period;
  }
}

/// Finer fringes of light that comes from far apart cancel (Gupta et al. 2011): their share of a period falls as well.
TEST(Interreflection, ErrorFallsWithThePeriodAndGrowsWithAlbedo) {
  const double coarse = errors_in(Groove(0.9, 64.0), false).measured_rms,
               fine = errors_in(Groove(0.9, 16.0), false).measured_rms,
               dark = errors_in(Groove(0.45, 64.0), false).measured_rms;
  EXPECT_LT(fine / 16.0, 0.6 * coarse / 64.0);
  EXPECT_NEAR(dark / coarse, 0.5, 0.1);  // light that met two faces has albedo squared, that which met one albedo
}

TEST(Interreflection, IndirectLightGrowsWithAlbedoSquared) {
  double light[2];
  for (const int i : {0, 1}) {
    const Groove groove(i ? 0.8 : 0.4, 16.0);
    Targets targets = groove.targets();
    const Scenery scenery = targets.scenery();
    const ProjectorLamp lamp(scenery, groove.setup.projector, groove.setup.projector_pose, targets.surfaces());
    const SeenPoint point{Vec3(0, 0, Groove::depth) + 0.01 * Groove::along(1), Groove::along(-1), 0, true};
    Gathered gathered;
    gather({scenery, targets.surfaces(), lamp}, point, Vec3::Zero(), {64, 1}, Random(1, 0, Stream::sensor), gathered);
    light[i] = 0.0;
    for (const Path& path : gathered.paths) light[i] += path.weight;
  }
  EXPECT_GT(light[0], 0.0);
  EXPECT_NEAR(light[1] / light[0], 4.0, 1e-9);
}

TEST(Interreflection, APlateThatNothingFacesIsUnchanged) {
  Groove groove(0.9, 16.0);
  groove.setup.noise = true;
  Targets targets;
  targets.add(box_target({0.5, 0.5, 0.02}), {Vec3(0, 0, 0.76), Quat(Eigen::AngleAxisd(0.3, Vec3::UnitY()))},
              {0.8, 0.4, 0.3});
  const Scenery scenery = targets.scenery();
  const View view = render(scenery, groove.camera, Pose(), groove.setup.near, groove.setup.far);
  const Random random(1, 0, Stream::noise);
  for (const bool decoded : {false, true}) {
    std::vector<Measurement> measured;
    for (const int bounces : {0, 2}) {
      groove.setup.indirect.bounces = bounces;
      const StructuredLight model(scenery, view, targets.surfaces(), groove.setup);
      measured.push_back(decoded ? model.decoded(random) : model.analytic(random));
    }
    EXPECT_EQ(measured[0].validity, measured[1].validity);
    EXPECT_EQ(measured[0].intensity, measured[1].intensity);
    EXPECT_EQ(0, std::memcmp(measured[0].depth.data(), measured[1].depth.data(), 8 * view.depth.size()));
  }
}

}  // namespace
}  // namespace bin_scenes
