#include "bin_scenes/sensor/sensor_rig.hpp"

#include "bin_scenes/sensor/resolve.hpp"
#include "raster/stage.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace bin_scenes {
namespace {

using test::box_mesh;

using test::at;
using test::turned;

/// A camera at the origin of the bin frame's own axes: optical frame = bin frame, looking along z.
struct Stage : test::Stage {
  Stage() {
    Sensor sensor;
    sensor.width = 320;
    sensor.height = 240;
    sensor.pose = Pose();
    request.sensors = {sensor};
  }
  RangeImage render() {
    scene.sensors = {resolved(request.sensors[0], request.bin)};
    return SensorRig().render(scene, {request, models}).front();
  }
};

Vec3 ray(const RangeImage& image, std::size_t i) {
  const std::vector<double>& k = image.sensor.k;
  const int column = static_cast<int>(i % image.sensor.width), row = static_cast<int>(i / image.sensor.width);
  return {(column - k[2]) / k[0], (row - k[5]) / k[4], 1.0};
}

TEST(SensorRig, PlaneStraightAheadAndTilted) {
  for (const double tilt : {0.0, 0.4, 1.1}) {
    Stage stage;
    const Quat turn = turned(tilt, Vec3(1, 2, 0));
    stage.place(stage.model(box_mesh({8, 8, 0.1}, {0, 0, 0.05})), at(0, 0, 1, turn));
    const RangeImage image = stage.render();
    const Vec3 normal = turn * Vec3::UnitZ();
    for (std::size_t i = 0; i < image.depth.size(); ++i) {
      const double expected = normal.z() / normal.dot(ray(image, i));
      if (!(expected > image.sensor.near && expected < 2.5)) continue;  // the plane's rim lies beyond
      ASSERT_NEAR(image.depth[i] / expected, 1.0, 1e-5) << i;
      ASSERT_EQ(image.label[i], 1);
      ASSERT_NEAR(image.normal[i][2], -normal.z(), 1e-5) << "towards the camera";
      ASSERT_NEAR(image.intensity[i], normal.dot(ray(image, i).normalized()), 1e-5);
    }
  }
}

TEST(SensorRig, SphereWithinItsFacets) {
  Stage stage;
  stage.place(stage.model(test::sphere_mesh(0.2, 5)), at(0.05, -0.03, 1.0));
  const RangeImage image = stage.render();
  const Vec3 center(0.05, -0.03, 1.0);
  int seen = 0;
  for (std::size_t i = 0; i < image.depth.size(); ++i) {
    const Vec3 r = ray(image, i);
    const double b = r.dot(center), d = b * b - r.squaredNorm() * (center.squaredNorm() - 0.04);
    if (d < -1e-3) {
      ASSERT_TRUE(std::isnan(image.depth[i])) << "nothing is seen beside the sphere";
    }
    if (d < 0.02) continue;  // glancing rays
    ASSERT_NEAR(image.depth[i], (b - std::sqrt(d)) / r.squaredNorm(), 5e-4) << i;
    ++seen;
  }
  EXPECT_GT(seen, 1000);
}

TEST(SensorRig, PixelsOfABoxAreItsProjectedArea) {
  Stage stage;
  const std::size_t box = stage.model(box_mesh({0.2, 0.1, 0.1}, {0, 0, 0.05}));
  stage.place(box, at(0, 0, 1));
  const RangeImage image = stage.render();
  const double f = image.sensor.k[0];
  EXPECT_NEAR(static_cast<double>(image.visible[0]), 0.2 * f * 0.1 * f, 0.3 * f + 4.0);  // half the outline
  EXPECT_EQ(image.visible[0], image.total[0]);
}

TEST(SensorRig, SilhouettesAreOfEachPartAlone) {
  Stage stage;
  const std::size_t box = stage.model(box_mesh({0.2, 0.1, 0.1}));
  stage.place(box, at(0, 0, 1));
  stage.place(box, at(0.05, 0.02, 1.3));  // partly behind the first
  stage.place(box, at(0, 0, 2));
  stage.scene.parts[2].state = PartState::not_poured;
  const RangeImage image = stage.render();
  ASSERT_EQ(image.silhouettes.size(), 3u);
  EXPECT_EQ(image.silhouettes[2].count, 0u);
  EXPECT_EQ(stage.scene.report.profile.counters["views"], 1u);
  EXPECT_EQ(stage.scene.report.profile.counters["silhouettes"], 2u) << "none of what is not there";
  ASSERT_LT(image.visible[1], image.total[1]);
  stage.scene.parts[0].state = PartState::not_poured;  // the second alone
  const RangeImage alone = stage.render();
  std::size_t covered = 0;
  for (int row = 0; row < 240; ++row) {
    for (int column = 0; column < 320; ++column) {
      const std::size_t i = static_cast<std::size_t>(row) * 320 + column;
      ASSERT_EQ(image.silhouettes[1].at(column, row), alone.label[i] == 2);
      ASSERT_TRUE(image.silhouettes[0].at(column, row) || image.label[i] != 1) << "what is seen belongs to it";
      covered += image.silhouettes[1].at(column, row);
    }
  }
  EXPECT_EQ(covered, image.total[1]);
  EXPECT_EQ(covered, alone.visible[1]);
}

TEST(SensorRig, WhatStandsInAHeapIsFlagged) {
  Stage stage;
  const std::size_t box = stage.model(box_mesh({0.2, 0.2, 0.2}));
  stage.place(box, at(0, 0, 1));
  stage.render();
  EXPECT_TRUE(stage.scene.report.flags.empty());
  stage.place(box, at(0, 0, 0.05));
  stage.render();
  ASSERT_EQ(stage.scene.report.flags.size(), 1u);
  EXPECT_EQ(stage.scene.report.flags[0].code, "sensor_inside_part");
  EXPECT_EQ(stage.scene.report.flags[0].text, "the camera of sensor 'camera' stands inside part 1");
  EXPECT_FALSE(stage.scene.report.flags[0].remedy.empty());
  stage.scene.parts[1].pose = at(0.3, 0, 0);
  stage.request.sensors[0].model = "structured_light";
  stage.request.sensors[0].projector.pose = at(0.3, 0, 0);
  stage.scene.report.flags.clear();
  stage.render();
  ASSERT_EQ(stage.scene.report.flags.size(), 1u);
  EXPECT_EQ(stage.scene.report.flags[0].text, "the projector of sensor 'camera' stands inside part 1");
}

TEST(SensorRig, ManyEqualPartsKeepTheirOwnLabels) {
  Stage stage;
  const std::size_t box = stage.model(box_mesh({0.02, 0.02, 0.02}));
  for (int i = 0; i < 300; ++i) stage.place(box, at(-0.3013 + 0.03 * (i % 20), -0.2007 + 0.03 * (i / 20), 1.0));
  const RangeImage image = stage.render();
  for (int i = 0; i < 300; ++i) {
    const Vec3 p = stage.scene.parts[i].pose.position;
    const int column = static_cast<int>(std::lround(image.sensor.k[0] * p.x() / 0.99 + image.sensor.k[2]));
    const int row = static_cast<int>(std::lround(image.sensor.k[4] * p.y() / 0.99 + image.sensor.k[5]));
    EXPECT_EQ(image.label[row * 320 + column], i + 1);
    EXPECT_LE(image.total[i] - image.visible[i], 1u) << "but for a ray that runs along an edge";
  }
}

TEST(SensorRig, HalfCoveredBox) {
  Stage stage;
  stage.request.sensors[0].k = {400, 0, 159.5, 0, 400, 119.5, 0, 0, 1};
  const std::size_t box = stage.model(box_mesh({0.2, 0.2, 0.1}, {0, 0, 0.05}));
  stage.place(box, at(0, 0, 1));
  stage.place(stage.model(box_mesh({0.5, 0.5, 0.01})), at(0.25, 0, 0.5));  // all of x > 0
  const RangeImage image = stage.render();
  EXPECT_EQ(image.total[0], 80u * 80u);
  EXPECT_EQ(image.visible[0], 40u * 80u);
  EXPECT_EQ(image.visible[1], image.total[1]);
}

TEST(SensorRig, ConcavePartsCountEachPixelOnce) {
  Stage stage;
  stage.place(stage.model(test::torus_mesh(0.2, 0.05, 48, 24)), at(0, 0, 1, turned(1.2, Vec3(1, 0.3, 0))));
  const RangeImage image = stage.render();
  EXPECT_GT(image.visible[0], 500u);
  EXPECT_EQ(image.visible[0], image.total[0]);
}

TEST(SensorRig, BinHasDepthButNoLabel) {
  Stage stage;
  stage.request.bin = Bin();
  stage.request.sensors[0].pose.reset();
  const RangeImage image = stage.render();
  const double eye = image.sensor.pose->position.z();
  const std::size_t middle = 120 * 320 + 160;
  EXPECT_NEAR(image.depth[middle], eye, 1e-5 * eye);
  EXPECT_EQ(image.label[middle], 0);
  std::size_t rim = 0;
  for (const float z : image.depth) rim += std::abs(z - (eye - 0.2)) < 1e-5;
  EXPECT_GT(rim, 500u) << "tops of the walls";
  stage.request.bin.kind = Bin::Kind::floor;
  const RangeImage floor = stage.render();
  const double above = floor.sensor.pose->position.z();
  for (const float z : floor.depth) ASSERT_NEAR(z, above, 1e-5 * above);
}

TEST(SensorRig, NothingOutsideNearAndFar) {
  Stage stage;
  stage.request.sensors[0].near = 0.5;
  stage.request.sensors[0].far = 2.0;
  const std::size_t box = stage.model(box_mesh({4, 4, 0.01}));
  stage.place(box, at(0, 0, 0.3));
  stage.place(box, at(0, 0, 2.3));
  const RangeImage image = stage.render();
  for (std::size_t i = 0; i < image.depth.size(); ++i) {
    ASSERT_TRUE(std::isnan(image.depth[i]));
    ASSERT_EQ(image.label[i], 0);
  }
  EXPECT_EQ(image.total[0], 0u);
}

TEST(SensorRig, CloudLiesOnTheTrueSurface) {
  Stage stage;
  const Mesh torus = test::torus_mesh(0.2, 0.05, 48, 24);
  const Pose pose = at(0.05, 0.02, 1.0, turned(0.7, Vec3(1, 1, 0)));
  stage.place(stage.model(torus), pose);
  const RangeImage image = stage.render();
  const MeshQuery query(torus);
  const auto points = points_of(image);
  int seen = 0;
  for (int row = 0; row < 240; ++row) {
    for (int column = 0; column < 320; ++column) {
      if (!image.label[row * 320 + column]) continue;
      const auto [x, y, z] = points[row * 320 + column];
      ASSERT_LT(query.nearest(pose.inverse() * Vec3(x, y, z)).distance, 1e-5) << column << " " << row;
      ++seen;
    }
  }
  EXPECT_GT(seen, 1000);
}

TEST(SensorRig, TwiceIsTheSameBitForBit) {
  Stage stage;
  stage.request.bin = Bin();
  stage.request.sensors[0].pose.reset();
  const std::size_t torus = stage.model(test::torus_mesh(0.04, 0.01, 48, 24));
  for (int i = 0; i < 20; ++i) {
    stage.place(torus, at(0.005 * i, -0.003 * i, 0.01 * i, turned(i, Vec3(1, i, 2))));
  }
  const RangeImage once = stage.render(), again = stage.render();
  EXPECT_EQ(0, std::memcmp(once.depth.data(), again.depth.data(), once.depth.size() * sizeof(float)));
  EXPECT_EQ(once.label, again.label);
  EXPECT_EQ(once.total, again.total);
}

TEST(SensorRig, AnEmptyBinIsSeenWithoutParts) {
  Stage stage;
  stage.request.bin = Bin();
  stage.request.sensors[0].pose.reset();
  const RangeImage image = stage.render();
  EXPECT_TRUE(image.visible.empty());
  EXPECT_TRUE(image.silhouettes.empty());
  const double eye = image.sensor.pose->position.z();
  EXPECT_NEAR(image.depth[120 * 320 + 160], eye, 1e-5);
  EXPECT_EQ(image.validity[120 * 320 + 160], 0);
}

TEST(SensorRig, SilhouettesBeyondTheImageAndAroundTheCameraAreCut) {
  Stage stage;
  const std::size_t box = stage.model(box_mesh({0.4, 0.4, 0.1}));
  stage.place(box, at(0.5, 0, 1));                             // half outside the image
  stage.place(box, at(3, 0, 1));                               // outside
  stage.place(box, at(0, 0, -1));                              // behind
  stage.place(stage.model(box_mesh({4, 4, 4})), at(0, 0, 0));  // the camera stands in it
  const RangeImage image = stage.render();
  EXPECT_GT(image.total[0], 1000u);
  EXPECT_EQ(image.total[1], 0u);
  EXPECT_EQ(image.total[2], 0u);
  EXPECT_EQ(image.total[3], 320u * 240u);
  EXPECT_EQ(stage.scene.parts[2].visible_fraction["camera"], 0.0);
}

TEST(SensorRig, VisibleFractionIsThatOfARayCast) {
  Stage stage;
  Lens lens = Lens::from_fov(160, 120, 0.7);
  Sensor& sensor = stage.request.sensors[0];
  sensor.width = 160, sensor.height = 120, sensor.fov = 0.7;
  const std::size_t lines[] = {stage.model(box_mesh({0.06, 0.2, 0.03})),
                               stage.model(test::torus_mesh(0.08, 0.03, 16, 8))};
  Random random(3, 0, Stream::probe);
  for (int i = 0; i < 8; ++i) {
    stage.place(lines[i % 2], {Vec3(random.uniform(-0.12, 0.12), random.uniform(-0.1, 0.1), random.uniform(0.7, 0.9)),
                               random.orientation()});
  }
  for (const bool distorted : {false, true}) {
    if (distorted) lens.distortion = sensor.distortion = {-0.25, 0.1, 0.002, -0.001, 0.0};
    const RangeImage image = stage.render();
    const test::BruteCast brute(stage);
    for (int id = 0; id < 8; ++id) {
      double seen = 0.0, alone = 0.0;
      for (int row = 0; row < 120; ++row) {
        for (int column = 0; column < 160; ++column) {
          const Vec3 ray = lens.ray(column, row);
          if (std::isnan(brute.hit(Vec3::Zero(), ray, 0.05, 10.0, id + 1).distance)) continue;
          ++alone;
          seen += brute.hit(Vec3::Zero(), ray, 0.05, 10.0).label == id + 1;
        }
      }
      ASSERT_GT(alone, 100.0);
      EXPECT_NEAR(stage.scene.parts[static_cast<std::size_t>(id)].visible_fraction["camera"], seen / alone, 0.005)
          << id;
    }
  }
}

/// A plate before a wall, once as a part and once as a distractor.
TEST(SensorRig, ADistractorIsSeenAndHidesOthersButHasNoLabel) {
  RangeImage images[2];
  Scene scenes[2];
  for (const bool distractor : {false, true}) {
    Stage stage;
    stage.request.sensors[0].model = "structured_light";
    stage.place(stage.model(box_mesh({1.0, 1.0, 0.1}, {0, 0, 0.05})), at(0, 0, 1.0));
    stage.place(stage.model(box_mesh({0.2, 0.2, 0.02})), at(0, 0, 0.8));
    stage.scene.parts[1].distractor = distractor;
    images[distractor] = stage.render();
    scenes[distractor] = stage.scene;
  }
  const RangeImage &part = images[0], &other = images[1];
  std::size_t hidden = 0;
  EXPECT_EQ(std::memcmp(part.depth.data(), other.depth.data(), part.depth.size() * sizeof(float)), 0);
  EXPECT_EQ(std::memcmp(part.truth_depth.data(), other.truth_depth.data(), part.depth.size() * sizeof(float)), 0);
  for (std::size_t i = 0; i < part.depth.size(); ++i) {
    ASSERT_EQ(other.label[i], part.label[i] == 2 ? 0 : part.label[i]) << i;
    ASSERT_EQ(other.truth_label[i], part.truth_label[i] == 2 ? 0 : part.truth_label[i]) << i;
    hidden += part.truth_label[i] == 2;
  }
  EXPECT_GT(hidden, 1000u);
  EXPECT_EQ(other.visible[0], part.visible[0]);
  EXPECT_EQ(other.total[0], part.total[0]);
  EXPECT_EQ(other.total[0] - other.visible[0], hidden);
  EXPECT_EQ(other.visible[1], 0u);
  EXPECT_EQ(other.total[1], 0u);
  EXPECT_EQ(scenes[1].parts[0].visible_fraction, scenes[0].parts[0].visible_fraction);
  EXPECT_TRUE(scenes[1].parts[1].visible_fraction.empty());
}

/// A table 0.1 m below a box bin: depth and normal of a plane, label 0, and light of the projector.
TEST(SensorRig, ATableIsMeasuredLikeAPlane) {
  for (const char* model : {"ideal", "structured_light", "stereo", "time_of_flight"}) {
    Stage stage;
    stage.request.bin.kind = Bin::Kind::box;
    stage.request.bin.inner_size = Vec3(0.2, 0.2, 0.1);
    stage.request.table.height = -0.1;
    Sensor& sensor = stage.request.sensors[0];
    sensor.model = model;
    sensor.noise = false;
    sensor.projector.fov = 1.3, sensor.projector.baseline = 0.05;
    sensor.pose = Pose{Vec3(0.0, 0.0, 0.9), turned(M_PI - 0.1, Vec3::UnitX())};
    const RangeImage image = stage.render();
    std::size_t seen = 0, measured = 0;
    std::array<std::size_t, 16> codes{};
    for (std::size_t i = 0; i < image.depth.size(); ++i) {
      const Vec3 along = sensor.pose->orientation * ray(image, i);
      const double depth = 1.0 / -along.z();
      const Vec3 point = sensor.pose->position + depth * along;
      if (point.head<2>().cwiseAbs().maxCoeff() < 0.25) continue;  // the bin, and what it hides
      ++seen, ++codes.at(image.validity[i]);
      ASSERT_NEAR(image.seen_depth()[i], depth, 1e-6) << model;
      ASSERT_EQ(image.seen_label()[i], 0) << model;
      const auto& n = image.seen_normal()[i];
      ASSERT_NEAR((sensor.pose->orientation * Vec3(n[0], n[1], n[2])).z(), 1.0, 1e-6) << model;
      if (std::isnan(image.depth[i])) continue;
      ++measured;
      ASSERT_NEAR(image.depth[i], depth, 2e-3) << model;
    }
    EXPECT_GT(seen, 10000u) << model;
    EXPECT_GT(measured, seen / 2) << model << ::testing::PrintToString(codes);
  }
}

/// The same table in the profiles of a laser that is moved across the bin.
TEST(SensorRig, ALaserLineMeasuresTheTableLikeAPlane) {
  Stage stage;
  stage.request.bin.kind = Bin::Kind::box;
  stage.request.bin.inner_size = Vec3(0.2, 0.2, 0.1);
  stage.request.table.height = -0.1;
  stage.request.table.mottle = 0.3;
  Sensor& sensor = stage.request.sensors[0];
  sensor.model = "laser_line";
  sensor.noise = false;
  sensor.laser.baseline = 0.2;
  sensor.scan.step = 0.01, sensor.scan.profiles = 100;
  sensor.pose = Pose{Vec3(0.0, 0.0, 0.9), turned(M_PI, Vec3::UnitX())};
  const RangeImage image = stage.render();
  std::size_t seen = 0;
  for (std::size_t i = 0; i < image.depth.size(); ++i) {
    if (std::isnan(image.depth[i])) continue;
    const auto& p = image.points[i];
    const Vec3 point = *sensor.pose * Vec3(p[0], p[1], p[2]);
    if (point.head<2>().cwiseAbs().maxCoeff() < 0.25) continue;
    ++seen;
    ASSERT_NEAR(point.z(), -0.1, 1e-3) << i;
    ASSERT_EQ(image.label[i], 0);
    const auto& n = image.normal[i];
    ASSERT_NEAR((sensor.pose->orientation * Vec3(n[0], n[1], n[2])).z(), 1.0, 1e-6);
  }
  EXPECT_GT(seen, image.depth.size() / 3);
}

}  // namespace
}  // namespace bin_scenes
