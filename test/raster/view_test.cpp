#include "bin_scenes/raster/view.hpp"

#include "bin_scenes/raster/silhouettes.hpp"
#include "raster/drawing.hpp"
#include "raster/fronts.hpp"
#include "raster/sight.hpp"
#include "raster/stage.hpp"

#include <gtest/gtest.h>

#include <tbb/global_control.h>

#include <cstring>

namespace bin_scenes {
namespace {

using test::at;
using test::BruteCast;
using test::BruteHit;
using test::Stage;
using test::turned;

/// Surroundings of parts: in a bin, on a floor, alone, and in a bin and alone above a table.
constexpr std::pair<Bin::Kind, double> surroundings[] = {{Bin::Kind::box, 0.0},
                                                         {Bin::Kind::floor, 0.0},
                                                         {Bin::Kind::none, 0.0},
                                                         {Bin::Kind::box, -0.04},
                                                         {Bin::Kind::none, -0.02}};
void surround(Stage& stage, const std::pair<Bin::Kind, double>& by) {
  stage.request.bin.kind = by.first;
  stage.request.table.height = by.second < 0.0 ? std::optional<double>(by.second) : std::nullopt;
}

/// Boxes, rings and spheres in all poses, some hidden by others, about the point (0, 0, z).
void scatter(Stage& stage, double z, std::uint64_t seed) {
  const std::size_t lines[] = {stage.model(test::box_mesh({0.06, 0.04, 0.03})), stage.model(test::sphere_mesh(0.03, 2)),
                               stage.model(test::box_mesh({0.12, 0.01, 0.02}, {0.03, 0.01, 0}))};
  Random random(seed, 0, Stream::probe);
  for (int i = 0; i < 12; ++i) {
    const Vec3 where(random.uniform(-0.15, 0.15), random.uniform(-0.12, 0.12), z + random.uniform(-0.08, 0.08));
    stage.place(lines[i % 3], {where, random.orientation()});
  }
}

/// Compares every pixel; those beside a border of labels, depths or faces in the reference are left out.
void expect_as_brute(const View& view, const BruteCast& brute, double near, double far, double tolerance) {
  const int w = view.lens.width, h = view.lens.height;
  std::vector<BruteHit> truth(static_cast<std::size_t>(w) * h);
  const auto index = [&](int column, int row) { return static_cast<std::size_t>(row) * w + column; };
  for (int row = 0; row < h; ++row) {
    for (int column = 0; column < w; ++column) {
      truth[index(column, row)] =
          brute.hit(view.pose.position, view.pose.orientation * view.lens.ray(column, row), near, far);
    }
  }
  std::size_t compared = 0, on_parts = 0;
  for (int row = 1; row + 1 < h; ++row) {
    for (int column = 1; column + 1 < w; ++column) {
      const std::size_t i = index(column, row);
      bool border = false;
      for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) border |= truth[index(column + x, row + y)].label != truth[i].label;
      }
      if (border) continue;
      ++compared;
      ASSERT_EQ(view.label[i], truth[i].label) << column << " " << row;
      ASSERT_EQ(std::isnan(view.depth[i]), std::isnan(truth[i].distance)) << column << " " << row;
      if (std::isnan(truth[i].distance)) continue;
      ++on_parts;
      ASSERT_NEAR(view.depth[i], truth[i].distance, tolerance * truth[i].distance) << column << " " << row;
    }
  }
  EXPECT_GT(compared, truth.size() / 2);
  EXPECT_GT(on_parts, 1000u);
}

TEST(View, IsWhatADoublePrecisionRayCastSees) {
  for (const double z : {0.5, 1.0, 2.0}) {
    Stage stage;
    scatter(stage, z, static_cast<std::uint64_t>(10 * z));
    // The scene is the same but the world is turned: neither the camera nor a part lies along the axes.
    const Pose world{Vec3(0.3, -0.2, 0.4), turned(0.7, Vec3(1, 2, 3))};
    for (ScenePart& part : stage.scene.parts) part.pose = world * part.pose;
    const Lens lens = Lens::from_fov(200, 160, 0.4 / z);
    const View view = render(stage.scenery(), lens, world, 0.05, 10.0);
    expect_as_brute(view, BruteCast(stage), 0.05, 10.0, 2e-6);
  }
}

/// Of a heap in a bin: label and depth of each pixel, those at borders too, and what of each part others hide.
TEST(View, DrawnIsWhatADoublePrecisionRayCastSeesUpToTheLastPixel) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    Stage stage;
    scatter(stage, 0.8, seed);
    Mesh open = test::box_mesh({0.08, 0.08, 0.05});
    open.triangles.resize(9);  // one sees into it, and through it
    stage.place(stage.model(open), {Vec3(0.02, 0.03, 0.7), turned(2.0, Vec3(seed, 1, 0))});
    const Pose world{Vec3(0.3, -0.2, 0.4), turned(0.7, Vec3(1, 2, 3))};
    for (ScenePart& part : stage.scene.parts) part.pose = world * part.pose;
    const Lens lens = Lens::from_fov(150, 120, 0.45);
    const SeenWithMasks seen = see(stage.scenery(), lens, world, 0.05, 10.0);
    ASSERT_TRUE(drawn(stage.scenery(), lens, world, 0.05, 10.0, nullptr)) << "nothing is left to rays here";
    const BruteCast brute(stage);
    for (int row = 0; row < lens.height; ++row) {
      for (int column = 0; column < lens.width; ++column) {
        const std::size_t i = static_cast<std::size_t>(row) * lens.width + column;
        const Vec3 ray = world.orientation * lens.ray(column, row);
        const BruteHit hit = brute.hit(world.position, ray, 0.05, 10.0);
        ASSERT_EQ(seen.view.label[i], hit.label) << column << " " << row;
        ASSERT_FALSE(std::abs(seen.view.depth[i] - hit.distance) > 1e-9) << column << " " << row;
        for (int part = 0; part < static_cast<int>(seen.alone.size()); ++part) {
          const bool covers = brute.hit(world.position, ray, 0.05, 10.0, part + 1).label != 0;
          ASSERT_EQ(seen.alone[static_cast<std::size_t>(part)].at(column, row), covers) << part << column << " " << row;
        }
      }
    }
  }
}

/// In a box bin and on a floor, near and far, where a part lies partly out of range or a wall behind the lens.
TEST(View, IsTheSameDrawnAndCast) {
  Stage stage;
  scatter(stage, 0.05, 7);
  const Lens lens = Lens::from_fov(160, 120, 0.9);
  for (const auto& by : surroundings) {
    surround(stage, by);
    for (const auto& [near, far] : {std::pair{0.01, 10.0}, {0.55, 10.0}, {0.01, 0.6}, {0.58, 0.62}}) {
      for (const double height : {0.6, 0.2}) {
        const Pose above = at(0.02, -0.01, height, turned(M_PI - 0.1, Vec3(1, 0.1, 0)));
        const Scenery scenery = stage.scenery();
        const View view = render(scenery, lens, above, near, far), rays = cast(scenery, lens, above, near, far);
        std::size_t other = 0;
        for (std::size_t i = 0; i < view.depth.size(); ++i) {
          const bool same = view.label[i] == rays.label[i] && view.line[i] == rays.line[i] &&
                            std::isnan(view.depth[i]) == std::isnan(rays.depth[i]) &&
                            !(std::abs(view.depth[i] - rays.depth[i]) > 1e-9) &&
                            !(std::abs(view.normal[i][2] - rays.normal[i][2]) > 1e-6);
          other += !same;
        }
        EXPECT_LE(other, 2u) << "Embree is single at edges: " << static_cast<int>(by.first) << " " << by.second << " "
                             << near << " " << height;
      }
    }
  }
}

/// Of parts beside and above each other in a bin, on a floor and alone.
TEST(View, WhatClearSightSparesNoRayIsBlocked) {
  for (const auto& by : surroundings) {
    Stage stage;
    scatter(stage, 0.1, 11);
    stage.place(stage.model(test::torus_mesh(0.05, 0.02, 32, 16)),
                {Vec3(0.05, 0.05, 0.15), turned(0.4, Vec3(1, 2, 0))});
    surround(stage, by);
    const Scenery scenery = stage.scenery();
    const Pose camera = at(0, 0, 0.9, Quat(0, 1, 0, 0)), light = at(0.15, 0, 0.9, turned(M_PI - 0.05, Vec3(1, 0.2, 0)));
    const Lens lens = Lens::from_fov(200, 160, 0.6);
    const View view = render(scenery, lens, camera, 0.05, 10.0);
    const Lens field = Lens::from_fov(600, 400, 0.9);
    const ClearSight sight(scenery, field, light);
    std::size_t spared = 0, lit = 0;
    for (std::size_t i = 0; i < view.depth.size(); ++i) {
      if (std::isnan(view.depth[i])) continue;
      const Vec3 normal = camera.orientation * Vec3(view.normal[i][0], view.normal[i][1], view.normal[i][2]);
      const Vec3 point =
          camera * (view.depth[i] * lens.ray(static_cast<double>(i % 200), static_cast<double>(i / 200)));
      if (normal.dot(light.position - point) <= 0.0) continue;
      const Ray ray{point + 1e-5 * normal, light.position - point - 1e-5 * normal, 0.0, 1.0};
      std::uint8_t blocked = 0;
      scenery.blocked(&ray, &blocked, 1);
      lit += blocked == 0;
      const Vec3 there = light.inverse() * point;
      if (!sight.clear(point, there, field.project(there).value_or(Eigen::Vector2d(-1.0, -1.0)),
                       scenery.face(view.face[i])))
        continue;
      ++spared;
      ASSERT_EQ(blocked, 0) << i % 200 << " " << i / 200 << " " << static_cast<int>(by.first) << by.second;
    }
    EXPECT_GT(spared, lit / 2) << static_cast<int>(by.first) << by.second;
  }
}

TEST(View, AMeshShowsOnlyFrontsIfItIsClosedAndNoShellIsTurnedInsideOut) {
  Mesh box = test::box_mesh({0.1, 0.1, 0.1});
  EXPECT_TRUE(shows_fronts_only(box));
  Mesh turned_inside_out = box, open = box;
  for (Triangle& t : turned_inside_out.triangles) std::swap(t[0], t[1]);
  open.triangles.pop_back();
  EXPECT_FALSE(shows_fronts_only(turned_inside_out));
  EXPECT_FALSE(shows_fronts_only(open));
}

TEST(View, SeesThroughADistortedLens) {
  Stage stage;
  scatter(stage, 0.6, 5);
  Lens lens = Lens::from_fov(200, 160, 0.7);
  lens.distortion = {-0.2, 0.08, 0.003, -0.002, -0.01};
  const View view = render(stage.scenery(), lens, Pose(), 0.05, 10.0);
  expect_as_brute(view, BruteCast(stage), 0.05, 10.0, 2e-6);
}

TEST(View, HasTheSameBitsOnOneThreadAndOnTwo) {
  Stage stage;
  scatter(stage, 1.0, 3);
  const Lens lens = Lens::from_fov(160, 120, 0.5);
  const auto once = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    SceneryCache cache;
    return render(Scenery(stage.scene, {stage.request, stage.models}, cache), lens, Pose(), 0.05, 10.0);
  };
  const View one = once(1), two = once(2);
  EXPECT_EQ(one.label, two.label);
  EXPECT_EQ(std::memcmp(one.depth.data(), two.depth.data(), one.depth.size() * sizeof(double)), 0);
  EXPECT_EQ(std::memcmp(one.normal.data(), two.normal.data(), one.normal.size() * sizeof one.normal[0]), 0);
}

TEST(View, FloorAndBoxHaveNoLabel) {
  Stage stage;
  stage.request.bin = Bin();
  const Pose above = at(0, 0, 1.0, Quat(0, 1, 0, 0));
  const Lens lens = Lens::from_fov(101, 101, 0.8);
  const View box = render(stage.scenery(), lens, above, 0.05, 10.0);
  const std::size_t middle = 50 * 101 + 50;
  EXPECT_NEAR(box.depth[middle], 1.0, 1e-12);
  EXPECT_EQ(box.label[middle], 0);
  EXPECT_EQ(box.line[middle], -1);
  EXPECT_NEAR(box.normal[middle][2], -1.0, 1e-6);
  stage.request.bin.kind = Bin::Kind::floor;
  const View floor = render(stage.scenery(), lens, above, 0.05, 10.0);
  for (const double depth : floor.depth) ASSERT_NEAR(depth, 1.0, 1e-12);
  for (const std::int32_t line : floor.line) ASSERT_EQ(line, -1);
  surround(stage, {Bin::Kind::none, -0.25});
  const View table = render(stage.scenery(), lens, above, 0.05, 10.0);
  for (const double depth : table.depth) ASSERT_NEAR(depth, 1.25, 1e-12);
  for (const std::int32_t line : table.line) ASSERT_EQ(line, Scenery::table_line);
  for (const std::uint16_t label : table.label) ASSERT_EQ(label, 0);
  surround(stage, {Bin::Kind::none, 0.0});
  for (const double depth : render(stage.scenery(), lens, above, 0.05, 10.0).depth) ASSERT_TRUE(std::isnan(depth));
}

TEST(View, SeesNothingBehindNearerOrFarther) {
  Stage stage;
  const std::size_t box = stage.model(test::box_mesh({0.1, 0.1, 0.1}));
  stage.place(box, at(0, 0, -0.5));  // behind
  stage.place(box, at(0, 0, 0.5));
  stage.place(box, Pose::none());  // nowhere
  stage.place(box, at(0, 0, 0.8));
  stage.scene.parts.back().state = PartState::not_poured;
  const Lens lens = Lens::from_fov(41, 41, 0.1);
  const std::size_t middle = 20 * 41 + 20;
  EXPECT_NEAR(render(stage.scenery(), lens, Pose(), 0.05, 10.0).depth[middle], 0.45, 1e-12);
  EXPECT_NEAR(render(stage.scenery(), lens, Pose(), 0.5, 10.0).depth[middle], 0.55, 1e-12)
      << "its far side, from inside";
  EXPECT_TRUE(std::isnan(render(stage.scenery(), lens, Pose(), 0.6, 10.0).depth[middle]));
  EXPECT_TRUE(std::isnan(render(stage.scenery(), lens, Pose(), 0.05, 0.4).depth[middle]));
}

TEST(Scenery, RaysAreBlockedByWhatLiesBetween) {
  Stage stage;
  stage.request.bin.kind = Bin::Kind::floor;
  const std::size_t box = stage.model(test::box_mesh({0.1, 0.1, 0.1}));
  stage.place(box, at(0, 0, 0.5));
  stage.place(box, at(0, 0, 1.0));
  const Scenery scenery = stage.scenery();
  const Vec3 down(0, 0, -1);
  const Ray rays[] = {{{0, 0, 2}, down, 0.0, 0.9},    // ends above the upper box
                      {{0, 0, 2}, down, 0.0, 1.0},    // ends inside it
                      {{0.2, 0, 2}, down, 0.0, 1.9},  // beside the boxes, above the floor
                      {{0.2, 0, 2}, down, 0.0, 2.1},  // to below the floor
                      {{0, 0, 2}, Vec3::Constant(NAN), 0.0, 9.0}};
  std::uint8_t blocked[5], first[5], second[5];
  scenery.blocked(rays, blocked, 5);
  EXPECT_EQ(std::vector<int>(blocked, blocked + 5), (std::vector<int>{0, 1, 0, 1, 0}));
  scenery.blocked_by(0, rays, first, 5);
  scenery.blocked_by(1, rays, second, 5);
  EXPECT_EQ(std::vector<int>(first, first + 5), (std::vector<int>{0, 0, 0, 0, 0}));
  EXPECT_EQ(std::vector<int>(second, second + 5), (std::vector<int>{0, 1, 0, 0, 0}));
}

}  // namespace
}  // namespace bin_scenes
