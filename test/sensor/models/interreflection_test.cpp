#include "sensor/models/interreflection.hpp"
#include "sensor/models/lobe.hpp"
#include "sensor/models/structured_light.hpp"
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
};

/// A box seen from within.
Targets furnace(const Surface& surface) {
  Mesh box = box_target({0.3, 0.2, 0.1});
  for (Triangle& t : box.triangles) std::swap(t[1], t[2]);
  Targets targets;
  targets.add(box, Pose(), surface);
  return targets;
}

double gathered(Targets& targets, int samples, int bounces) {
  const Scenery scenery = targets.scenery();
  Gathered light;
  double sum = 0.0;
  const std::vector<Vec3> places = {{0.02, 0.03, 0.05}, {0.14, 0.09, 0.05}, {-0.1, 0.0, 0.05}};
  for (std::size_t i = 0; i < places.size(); ++i) {
    const SeenPoint point{places[i], -Vec3::UnitZ(), 0, true};
    gather(scenery, EvenLamp(), targets.surfaces(), point, {-0.05, 0.02, -0.04}, samples, bounces,
           Random(1, i, Stream::sensor), light);
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
}

/// What is drawn is as dense as it says: the density integrates to the share of samples above the surface.
TEST(Interreflection, SamplesFollowTheLobe) {
  for (const double roughness : {0.15, 0.4, 0.9}) {
    for (const double degrees : {0.0, 45.0, 80.0, 87.0}) {
      const double t = degrees * M_PI / 180.0;
      const Lobe lobe({0.8, 0.9, roughness}, Vec3::UnitZ(), Vec3(std::sin(t), 0.0, std::cos(t)));
      constexpr int side = 300;
      double sent = 0.0;
      for (int i = 0; i < side; ++i) {
        for (int k = 0; k < side; ++k) sent += lobe.at((i + 0.5) / side, (k + 0.5) / side).factor / (side * side);
      }
      EXPECT_NEAR(sent, 0.8, 0.008) << roughness << " " << degrees;
    }
  }
}

/// Two matte faces at right angles, 57 mm wide, that meet in a line along y at 0.75 m.
struct Groove {
  static constexpr double width = 0.057, length = 0.6, depth = 0.75;
  Surface surface;
  StructuredLight::Setup setup;
  Lens camera = Lens::from_fov(200, 24, 0.112);

  explicit Groove(double albedo, double period) : surface{albedo, 0.0, 0.4} {
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
  Targets targets() const {
    Mesh mesh;
    for (const int side : {-1, 1}) {
      const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
      for (const double far : {0.0, width}) {
        for (const double y : {-0.5 * length, 0.5 * length}) {
          mesh.vertices.push_back(Vec3(0, 0, depth) + far * along(side) + y * Vec3::UnitY());
        }
      }
      mesh.triangles.push_back({base, base + 1, base + 2});
      mesh.triangles.push_back({base + 1, base + 3, base + 2});
    }
    Targets targets;
    targets.add(mesh, Pose(), surface);
    return targets;
  }
  double column(const Vec3& point) const {
    return setup.projector.project(setup.projector_pose.inverse() * point)->x();
  }
  /// Light of the projector's white that a point of a face sends back.
  double white(const Vec3& point, const Vec3& normal) const {
    const Vec3 way = setup.projector_pose.position - point;
    return surface.albedo * normal.dot(way.normalized()) / way.squaredNorm();
  }
  /// Columns by which the light of the other face moves what is read at a point of a face.
  double column_error(const Vec3& point) const {
    constexpr int slices = 200, turns = 50;
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
        const double factor = normal.dot(way) * -other_normal.dot(way) / (M_PI * r2 * r2) * ds * dy;
        sum += surface.albedo * factor * white(from, other_normal) * std::polar(1.0, turn * column(from));
      }
    }
    const std::complex<double> direct = std::polar(white(point, normal), turn * column(point));
    return std::arg((direct + sum) / direct) / turn;
  }
};

struct Errors {
  double expected = 0.0;  ///< largest that the integration gives
  double off = 0.0;       ///< largest difference of what was measured
  double expected_rms = 0.0, measured_rms = 0.0, off_rms = 0.0;
};

/// Columns; every pixel of a row.
Errors errors_in(const Groove& groove, bool decoded) {
  Targets targets = groove.targets();
  const Scenery scenery = targets.scenery();
  const View view = render(scenery, groove.camera, Pose(), groove.setup.near, groove.setup.far);
  const StructuredLight model(scenery, view, targets.surfaces(), groove.setup);
  const Random random(1, 0, Stream::noise);
  const Measurement measured = decoded ? model.decoded(random) : model.analytic(random);
  Errors out;
  int count = 0;
  for (const int row : {5}) {
    for (int x = 2; x < groove.camera.width - 2; ++x) {
      const std::size_t i = static_cast<std::size_t>(row * groove.camera.width + x);
      const Vec3 ray = groove.camera.ray(x, row), point = view.depth[i] * ray;
      const double from_line = (point - Vec3(0, 0, Groove::depth)).head<3>().cwiseAbs().maxCoeff();
      if (std::isnan(view.depth[i]) || std::abs(point.x()) < 0.0008 || from_line > 0.0395) continue;
      if (measured.validity[i] != Validity::valid) {
        ADD_FAILURE() << "pixel " << x << " " << row << " has code " << int(measured.validity[i]);
        continue;
      }
      const double expected = groove.column_error(point);
      const double seen = groove.column(measured.depth[i] * ray) - groove.column(point);
      out.expected = std::max(out.expected, std::abs(expected));
      out.off = std::max(out.off, std::abs(seen - expected));
      out.expected_rms += expected * expected;
      out.measured_rms += seen * seen;
      out.off_rms += (seen - expected) * (seen - expected);
      ++count;
    }
  }
  EXPECT_GT(count, 120);
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

/// As many rays as by default: what they leave is less than what they tell.
TEST(Interreflection, FewRaysFindTheErrorInTheMean) {
  const Errors e = errors_in(Groove(0.9, 64.0), false);
  EXPECT_NEAR(e.measured_rms / e.expected_rms, 1.0, 0.1);
  EXPECT_LT(e.off_rms, 0.3 * e.expected_rms);
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
    gather(scenery, lamp, targets.surfaces(), point, Vec3::Zero(), 64, 1, Random(1, 0, Stream::sensor), gathered);
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
