/// What makes pictures resemble photographs: depth of field, sharp reflections in reflections, bevels, and the table.
#include "sensor/models/image_optics.hpp"

#include "light/tabletop.hpp"
#include "sensor/models/image.hpp"
#include "sensor/models/image_stage.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace bin_scenes {
namespace {

using namespace test;

/// Radiance by column, the mean over the rows.
std::vector<double> by_column(Targets& targets, const Sensor& sensor, const PathTracer::Setup& setup) {
  const Scenery scenery = targets.scenery();
  const Lamps lamps = lamps_of(sensor);
  const PathTracer tracer(scenery, lens_of(sensor), *sensor.pose, targets.surfaces(), lamps, setup,
                          Random(3, 0, Stream::sensor));
  std::vector<double> columns(static_cast<std::size_t>(sensor.width));
  for (int row = 0; row < sensor.height; ++row) {
    const std::vector<Rgb> rgb = tracer.row(static_cast<std::size_t>(row));
    for (std::size_t x = 0; x < columns.size(); ++x) columns[x] += rgb[x].mean() / sensor.height;
  }
  return columns;
}

/// A black plate at a depth z before a dome, whose edge at x = 0 blurs to a disk of diameter A fx |1 / z - 1 / focus|.
/// Across the edge, its brightness rises by the disk's chords, whose variance is a sixteenth of the squared diameter.
TEST(ImageOptics, CircleOfConfusion) {
  for (const double z : {0.8, 1.0, 1.25}) {
    Targets targets;
    targets.add(box_target({2.0, 4.0, 1e-5}), {Vec3(-1.0, 0.0, z), Quat::Identity()}, {0.0, 0.0, 0.4});
    const Sensor sensor = camera({dome(1.0)}, 121, 8, 0.1224);
    PathTracer::Setup setup;
    setup.samples = 1024, setup.bounces = 0;
    setup.aperture = 0.05, setup.focus = 1.0;
    const std::vector<double> row = by_column(targets, sensor, setup);
    EXPECT_NEAR(row.front(), 0.0, 1e-12);
    EXPECT_NEAR(row.back(), 1.0, 1e-12);
    if (z == 1.0) {  // sharp: the edge crosses the middle of a pixel
      EXPECT_NEAR(row[59], 0.0, 1e-12);
      EXPECT_NEAR(row[61], 1.0, 1e-12);
      continue;
    }
    double mean = 0.0, square = 0.0;
    for (std::size_t x = 0; x + 1 < row.size(); ++x) {
      const double rise = row[x + 1] - row[x], at = static_cast<double>(x) + 0.5 - lens_of(sensor).cx;
      mean += rise * at, square += rise * at * at;
    }
    const double of_pixels = 1.0 / 6.0;  // variance of the difference of neighbours across a sharp edge
    const double closed_form = 0.05 * lens_of(sensor).fx * std::abs(1.0 / z - 1.0);
    EXPECT_NEAR(mean, 0.0, 0.05) << z;
    EXPECT_NEAR(4.0 * std::sqrt(square - mean * mean - of_pixels), closed_form, 0.01 * closed_form) << z;
  }
}

/// A periscope of two perfect mirrors: a lamp appears as wide as at the end of the unfolded path.
TEST(ImageOptics, AMirrorInAMirrorShowsALampWhereItIs) {
  const Surface mirror{1.0, 1.0, 0.0};
  const Quat tilted(Eigen::AngleAxisd(-M_PI / 4.0, Vec3::UnitY()));
  const Vec3 back = tilted * Vec3(0.0, 0.0, 0.005);
  Targets targets;
  targets.add(box_target({0.6, 0.6, 0.01}), {Vec3(0.0, 0.0, 1.0) + back, tilted}, mirror);
  targets.add(box_target({0.6, 0.6, 0.01}), {Vec3(1.0, 0.0, 1.0) - back, tilted}, mirror);
  ImageLamp lamp = flat(ImageLamp::Type::area, Vec3(1.0, 0.0, 2.0), Quat(0.0, 1.0, 0.0, 0.0));
  lamp.width = lamp.height = 0.2;
  const Sensor sensor = camera({lamp}, 101, 1, 0.1);
  PathTracer::Setup setup;
  setup.samples = 2048, setup.bounces = 1;
  const double half_width = lens_of(sensor).fx * 0.1 / 3.0;  // pixels; the path is 1 + 1 + 1 m long
  const auto mean_between = [&](const std::vector<double>& row, double from, double to) {
    double sum = 0.0, count = 0.0;
    for (std::size_t x = 0; x < row.size(); ++x) {
      const double off = std::abs(static_cast<double>(x) - 50.0) / half_width;
      if (off >= from && off <= to) sum += row[x], count += 1.0;
    }
    return sum / count;
  };
  setup.soft = 0.0;
  const std::vector<double> sharp = by_column(targets, sensor, setup);
  EXPECT_NEAR(mean_between(sharp, 0.0, 0.9), 1.0, 0.02);
  EXPECT_NEAR(mean_between(sharp, 1.1, 9.0), 0.0, 0.01);
  setup.soft = 0.5;
  EXPECT_LT(mean_between(by_column(targets, sensor, setup), 0.0, 0.9), 0.5);
}

/// The normal at a point of a face is that of the circle which a line along the bisector meets.
TEST(ImageOptics, ABevelIsAFillet) {
  constexpr double r = 0.002;
  Targets targets;
  targets.add(box_target({0.1, 0.1, 0.1}), Pose(), {0.5, 0.0, 0.4});
  const Scenery scenery = targets.scenery();
  const Bevels bevels(scenery, r);
  const Vec3 center(0.05 - r, 0.0, 0.05 - r), bisector = Vec3(1.0, 0.0, 1.0).normalized();
  for (const double from_edge : {1e-5, 0.0005, 0.001, 0.0015, 0.0019, 0.0021, 0.01}) {
    const Vec3 point(0.05 - from_edge, 0.01, 0.05);
    Hit hit;
    const Ray ray{Vec3(point.x(), point.y(), 1.0), -Vec3::UnitZ()};
    scenery.first_hits(&ray, &hit, 1);
    Vec3 closed_form = Vec3::UnitZ();
    if (from_edge < r) {
      const Vec3 offset = point - Vec3(center.x(), point.y(), center.z());
      const double along = offset.dot(bisector);  // where the line leaves the circle
      const Vec3 across = offset - along * bisector;
      closed_form = (across + std::sqrt(r * r - across.squaredNorm()) * bisector) / r;
    }
    EXPECT_LT((bevels.normal(hit, point, hit.normal) - closed_form).norm(), 1e-6) << from_edge;
  }
}

/// The band of an edge that mirrors a small lamp on the bisector grows with the radius.
TEST(ImageOptics, ABevelWidensAHighlight) {
  double widths[2] = {};
  for (int i = 0; i < 2; ++i) {
    Targets targets;
    const Quat edge_on(Eigen::AngleAxisd(M_PI / 4.0, Vec3::UnitY()));
    targets.add(box_target({0.1, 0.1, 0.1}), {Vec3(0.0, 0.0, 0.6), edge_on}, {1.0, 1.0, 0.2});
    ImageLamp ring = flat(ImageLamp::Type::ring, Vec3(0.0, 0.0, -0.01));
    ring.inner = 0.0, ring.outer = 0.05;
    const Sensor sensor = camera({ring}, 401, 1, 0.06);
    const Scenery scenery = targets.scenery();
    const Bevels bevels(scenery, 0.003 * (i + 1));
    PathTracer::Setup setup;
    setup.samples = 64, setup.bounces = 0, setup.bevels = &bevels;
    for (const double value : by_column(targets, sensor, setup)) widths[i] += value;
    setup.bevels = nullptr;
    for (const double value : by_column(targets, sensor, setup)) EXPECT_LT(value, 0.01);
  }
  EXPECT_NEAR(widths[1], 2.0 * widths[0], 0.1 * widths[0]);
}

/// Under an even dome, the table has its albedo as radiance, and what is on it hides it and is lit by it as well.
TEST(ImageOptics, TableUnderADome) {
  Sensor sensor = camera({dome(1.0)}, 21, 1, 0.5);
  sensor.pose = Pose{Vec3(0.0, 0.0, 1.0), Quat(0.0, 1.0, 0.0, 0.0)};
  Table table;
  table.height = -0.2, table.surface.albedo = 0.4;
  Targets targets;
  targets.add(box_target({0.1, 0.1, 0.1}), Pose(), {0.0, 0.0, 0.4});
  targets.set_table(table);
  PathTracer::Setup setup;
  setup.samples = 64, setup.bounces = 0;
  const std::vector<double> row = by_column(targets, sensor, setup);
  EXPECT_EQ(row[10], 0.0);
  EXPECT_NEAR(row[0], 0.4, 0.03);  // the box hides a little of the dome
}

TEST(ImageOptics, PatchesOfATableKeepItsMeanAndDifferByKey) {
  Table table;
  table.surface.albedo = 0.4, table.mottle = 0.5;
  double sum = 0.0, square = 0.0, apart = 0.0;
  constexpr int side = 200;
  for (int i = 0; i < side * side; ++i) {
    const Vec3 point(0.02 * (i % side), 0.02 * (i / side), 0.0);
    const double albedo = table_surface(table, point, 7).albedo;
    sum += albedo, square += albedo * albedo;
    apart += std::abs(albedo - table_surface(table, point, 8).albedo);
    ASSERT_TRUE(albedo >= 0.2 && albedo <= 0.6);
  }
  constexpr double count = side * side;
  EXPECT_NEAR(sum / count, 0.4, 0.01);
  EXPECT_GT(std::sqrt(square / count - std::pow(sum / count, 2)), 0.03);
  EXPECT_GT(apart / count, 0.03);
}

}  // namespace
}  // namespace bin_scenes
