#include "bin_scenes/sensor/range_camera.hpp"

#include "part/shapes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace bin_scenes {
namespace {

using test::box_mesh;

/// A camera at the origin of the bin frame's own axes: optical frame = bin frame, looking along z.
struct Stage {
  Request request;
  Scene scene;
  std::vector<PartModelPtr> models;

  Stage() {
    request.bin.kind = Bin::Kind::none;
    Sensor sensor;
    sensor.width = 320;
    sensor.height = 240;
    sensor.pose = Pose();
    request.sensors = {sensor};
  }
  std::size_t model(const Mesh& mesh) {
    models.push_back(PartModel::from_mesh(mesh, "shape" + std::to_string(models.size())));
    request.parts.emplace_back();
    return models.size() - 1;
  }
  void place(std::size_t line, const Pose& pose) {
    ScenePart part;
    part.id = static_cast<int>(scene.parts.size());
    part.line = line;
    part.pose = pose;
    part.state = PartState::resting;
    scene.parts.push_back(part);
  }
  RangeImage render() { return RangeCamera().render(scene, request, models).front(); }
};

Pose at(double x, double y, double z, const Quat& turn = Quat::Identity()) {
  return {Vec3(x, y, z), turn};
}
Quat turned(double angle, const Vec3& axis) {
  return Quat(Eigen::AngleAxisd(angle, axis.normalized()));
}

Vec3 ray(const RangeImage& image, std::size_t i) {
  const std::vector<double>& k = image.sensor.k;
  const int column = static_cast<int>(i % image.sensor.width), row = static_cast<int>(i / image.sensor.width);
  return {(column - k[2]) / k[0], (row - k[5]) / k[4], 1.0};
}

TEST(RangeCamera, PlaneStraightAheadAndTilted) {
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

TEST(RangeCamera, SphereWithinItsFacets) {
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

TEST(RangeCamera, PixelsOfABoxAreItsProjectedArea) {
  Stage stage;
  const std::size_t box = stage.model(box_mesh({0.2, 0.1, 0.1}, {0, 0, 0.05}));
  stage.place(box, at(0, 0, 1));
  const RangeImage image = stage.render();
  const double f = image.sensor.k[0];
  EXPECT_NEAR(static_cast<double>(image.visible[0]), 0.2 * f * 0.1 * f, 0.3 * f + 4.0);  // half the outline
  EXPECT_EQ(image.visible[0], image.total[0]);
}

TEST(RangeCamera, SilhouettesAreOfEachPartAlone) {
  Stage stage;
  const std::size_t box = stage.model(box_mesh({0.2, 0.1, 0.1}));
  stage.place(box, at(0, 0, 1));
  stage.place(box, at(0.05, 0.02, 1.3));  // partly behind the first
  stage.place(box, at(0, 0, 2));
  stage.scene.parts[2].state = PartState::not_poured;
  EXPECT_TRUE(stage.render().silhouette.empty()) << "only if asked for";
  const RangeImage image = RangeCamera().render(stage.scene, stage.request, stage.models, nullptr, true).front();
  ASSERT_EQ(image.silhouette.size(), 3u);
  EXPECT_TRUE(image.silhouette[2].empty());
  ASSERT_LT(image.visible[1], image.total[1]);
  for (std::size_t id = 0; id < 2; ++id) {
    const std::vector<bool>& pixels = image.silhouette[id];
    ASSERT_EQ(pixels.size(), image.label.size());
    EXPECT_EQ(static_cast<std::size_t>(std::count(pixels.begin(), pixels.end(), true)), image.total[id]);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      ASSERT_TRUE(pixels[i] || image.label[i] != id + 1) << "what is seen belongs to it";
    }
  }
}

TEST(RangeCamera, ManyEqualPartsKeepTheirOwnLabels) {
  Stage stage;
  const std::size_t box = stage.model(box_mesh({0.02, 0.02, 0.02}));
  for (int i = 0; i < 300; ++i) stage.place(box, at(-0.3 + 0.03 * (i % 20), -0.2 + 0.03 * (i / 20), 1.0));
  const RangeImage image = stage.render();
  for (int i = 0; i < 300; ++i) {
    const Vec3 p = stage.scene.parts[i].pose.position;
    const int column = static_cast<int>(std::lround(image.sensor.k[0] * p.x() / 0.99 + image.sensor.k[2]));
    const int row = static_cast<int>(std::lround(image.sensor.k[4] * p.y() / 0.99 + image.sensor.k[5]));
    EXPECT_EQ(image.label[row * 320 + column], i + 1);
    EXPECT_EQ(image.visible[i], image.total[i]) << "300 parts: stencil marks are used more than once";
  }
}

TEST(RangeCamera, HalfCoveredBox) {
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

TEST(RangeCamera, ConcavePartsCountEachPixelOnce) {
  Stage stage;
  stage.place(stage.model(test::torus_mesh(0.2, 0.05, 48, 24)), at(0, 0, 1, turned(1.2, Vec3(1, 0.3, 0))));
  const RangeImage image = stage.render();
  EXPECT_GT(image.visible[0], 500u);
  EXPECT_EQ(image.visible[0], image.total[0]);
}

TEST(RangeCamera, BinHasDepthButNoLabel) {
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

TEST(RangeCamera, NothingOutsideNearAndFar) {
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

TEST(RangeCamera, CloudLiesOnTheTrueSurface) {
  Stage stage;
  const Mesh torus = test::torus_mesh(0.2, 0.05, 48, 24);
  const Pose pose = at(0.05, 0.02, 1.0, turned(0.7, Vec3(1, 1, 0)));
  stage.place(stage.model(torus), pose);
  const RangeImage image = stage.render();
  const MeshQuery query(torus);
  int seen = 0;
  for (int row = 0; row < 240; ++row) {
    for (int column = 0; column < 320; ++column) {
      if (!image.label[row * 320 + column]) continue;
      const auto [x, y, z] = point_at(image, column, row);
      ASSERT_LT(query.nearest(pose.inverse() * Vec3(x, y, z)).distance, 1e-5) << column << " " << row;
      ++seen;
    }
  }
  EXPECT_GT(seen, 1000);
}

TEST(RangeCamera, TwiceIsTheSameBitForBit) {
  Stage stage;
  stage.request.bin = Bin();
  stage.request.sensors[0].pose.reset();
  const std::size_t torus = stage.model(test::torus_mesh(0.04, 0.01, 48, 24));
  for (int i = 0; i < 20; ++i) {
    stage.place(torus, at(0.005 * i, -0.003 * i, 0.01 * i, turned(i, Vec3(1, i, 2))));
  }
  RangeCamera camera;
  const RangeImage once = camera.render(stage.scene, stage.request, stage.models).front();
  const RangeImage again = camera.render(stage.scene, stage.request, stage.models).front();
  EXPECT_EQ(0, std::memcmp(once.depth.data(), again.depth.data(), once.depth.size() * sizeof(float)));
  EXPECT_EQ(once.label, again.label);
  EXPECT_EQ(once.total, again.total);
}

}  // namespace
}  // namespace bin_scenes
