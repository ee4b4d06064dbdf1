#include "raster/spots.hpp"

#include "bin_scenes/core/random.hpp"
#include "raster/stage.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace bin_scenes {
namespace {

using test::at;
using test::BruteCast;
using test::BruteHit;
using test::Stage;
using test::turned;

/// Closed and open meshes in all poses before the camera, some in others.
void heap(Stage& stage, std::uint64_t seed) {
  Mesh open = test::box_mesh({0.08, 0.08, 0.05});
  open.triangles.resize(9);
  const std::size_t lines[] = {stage.model(test::box_mesh({0.06, 0.04, 0.03})), stage.model(test::sphere_mesh(0.03, 2)),
                               stage.model(test::torus_mesh(0.04, 0.015, 24, 12)), stage.model(open)};
  Random random(seed, 0, Stream::probe);
  for (int i = 0; i < 16; ++i) {
    const Vec3 where(random.uniform(-0.15, 0.15), random.uniform(-0.12, 0.12), 0.8 + random.uniform(-0.08, 0.08));
    stage.place(lines[i % 4], {where, random.orientation()});
  }
  stage.place(stage.model(test::box_mesh({4.0, 4.0, 0.02})), at(0, 0, 0.95));
}

/// Places of all pixels, as far from their centres as they may lie.
std::vector<Spot> spread(const Lens& lens, double far, Random random) {
  std::vector<Spot> spots;
  for (int k = 0; k < 4 * lens.width * lens.height; ++k) {
    const double u = k / 4 % lens.width + random.uniform(-0.5, 0.5), v = k / 4 / lens.width + random.uniform(-0.5, 0.5);
    spots.push_back({u, v, 1.0 / far, Scenery::no_face});
  }
  return spots;
}

TEST(Spots, ShowWhatADoublePrecisionRayCastMeets) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    Stage stage;
    heap(stage, seed);
    const Pose world{Vec3(0.3, -0.2, 0.4), turned(0.7, Vec3(1, 2, 3))};
    for (ScenePart& part : stage.scene.parts) part.pose = world * part.pose;
    const Scenery scenery = stage.scenery();
    const Lens lens = Lens::from_fov(70, 50, 0.45);
    // The nearer end of the range cuts through parts: one sees into them.
    for (const double near : {0.05, 0.78}) {
      std::vector<Spot> spots = spread(lens, 10.0, Random(seed, 1, Stream::probe));
      ASSERT_TRUE(SpotDrawing(scenery, lens, world, near, 10.0).draw(spots.data(), spots.size()));
      const BruteCast brute(stage);
      std::size_t on_parts = 0;
      for (const Spot& spot : spots) {
        const Ray ray{world.position, world.orientation * lens.ray(spot.u, spot.v), near, 10.0};
        const BruteHit truth = brute.hit(ray.origin, ray.direction, near, 10.0);
        const Hit hit = scenery.hit(ray, spot.face, 1.0 / spot.near);
        ASSERT_EQ(hit.label, truth.label) << spot.u << " " << spot.v;
        ASSERT_FALSE(std::abs(hit.distance - truth.distance) > 1e-9) << spot.u << " " << spot.v;
        on_parts += truth.label != 0 && truth.label < 17;
      }
      EXPECT_GT(on_parts, spots.size() / 8);
    }
  }
}

/// Of points just above what a camera beside the light sees.
TEST(Spots, AreShadedWhereADoublePrecisionRayIsBlocked) {
  const double far = std::numeric_limits<double>::infinity();
  for (const std::uint64_t seed : {4u, 5u}) {
    Stage stage;
    heap(stage, seed);
    const Scenery scenery = stage.scenery();
    const Lens lens = Lens::from_fov(120, 90, 0.45), light = Lens::from_fov(300, 200, 0.9);
    const Pose lamp = at(0.15, 0.02, 0.05, turned(-0.1, Vec3(0.1, 1, 0)));
    std::vector<Spot> spots;
    std::vector<Ray> rays;
    for (int k = 0; k < lens.width * lens.height; ++k) {
      const Ray eye{Vec3::Zero(), lens.ray(k % lens.width, k / lens.width), 0.05, 10.0};
      Hit hit;
      scenery.first_hits(&eye, &hit, 1);
      const Vec3 start = hit.distance * eye.direction + 1e-5 * hit.normal;
      if (!(hit.normal.dot(lamp.position - start) > 0.0)) continue;
      const Vec3 there = lamp.inverse() * start;
      const Eigen::Vector2d pixel = *light.project(there);
      if (!light.inside(pixel)) continue;
      spots.push_back({pixel.x(), pixel.y(), 1.0 / there.z(), Scenery::no_face});
      rays.push_back({start, lamp.position - start, 0.0, 1.0});
    }
    ASSERT_TRUE(SpotDrawing(scenery, light, lamp, 0.0, far).draw(spots.data(), spots.size()));
    const BruteCast brute(stage);
    std::size_t shaded = 0;
    for (std::size_t i = 0; i < spots.size(); ++i) {
      const bool blocked = brute.hit(rays[i].origin, rays[i].direction, 0.0, 1.0).label != 0;
      ASSERT_EQ(spots[i].face != Scenery::no_face, blocked) << i;
      shaded += blocked;
    }
    EXPECT_GT(shaded, spots.size() / 50);
    EXPECT_LT(shaded, spots.size() / 2);
  }
}

TEST(Spots, ShowTheFloorFromBothSides) {
  Stage stage;
  stage.request.bin.kind = Bin::Kind::floor;
  stage.place(stage.model(test::box_mesh({0.06, 0.04, 0.03})), at(0, 0, 0.1));
  const Lens lens = Lens::from_fov(40, 30, 0.9);
  for (const double height : {0.0, -0.1}) {
    if (height < 0.0) stage.request.bin.kind = Bin::Kind::none, stage.request.table.height = height;
    const Scenery scenery = stage.scenery();
    for (const Pose& camera :
         {at(0, 0, 0.6, turned(M_PI - 0.4, Vec3(1, 0.1, 0))), at(0, 0, height - 0.3, turned(0.4, Vec3(1, 0, 0)))}) {
      std::vector<Spot> spots = spread(lens, 5.0, Random(1, 1, Stream::probe));
      ASSERT_TRUE(SpotDrawing(scenery, lens, camera, 0.05, 5.0).draw(spots.data(), spots.size()));
      for (const Spot& spot : spots) {
        const Ray ray{camera.position, camera.orientation * lens.ray(spot.u, spot.v), 0.05, 5.0};
        Hit truth;
        scenery.first_hits(&ray, &truth, 1);
        const Hit hit = scenery.hit(ray, spot.face, 1.0 / spot.near);
        if (std::isnan(truth.distance)) {
          ASSERT_EQ(spot.face, Scenery::no_face);
        } else {
          ASSERT_NEAR(hit.distance, truth.distance, 1e-9) << spot.u << " " << spot.v;
          ASSERT_EQ(hit.normal, truth.normal);
        }
      }
    }
  }
}

TEST(Spots, AreLeftToRaysWhereDrawingCannotSee) {
  Stage stage;
  stage.place(stage.model(test::box_mesh({0.06, 0.04, 0.03})), at(0, 0, 0.5));
  Lens lens = Lens::from_fov(40, 30, 0.9);
  std::vector<Spot> spots = spread(lens, 5.0, Random(1, 1, Stream::probe));
  const std::vector<Spot> before = spots;
  EXPECT_FALSE(SpotDrawing(stage.scenery(), lens, at(0, 0, 0.5), 0.01, 5.0).draw(spots.data(), spots.size()))
      << "the mesh reaches behind the lens";
  lens.distortion[0] = 0.1;
  EXPECT_FALSE(SpotDrawing(stage.scenery(), lens, Pose(), 0.05, 5.0).draw(spots.data(), spots.size()));
  lens.distortion[0] = 0.0;
  const std::size_t sphere = stage.model(test::sphere_mesh(0.03, 4));
  stage.place(sphere, at(0.1, 0, 0.5));
  EXPECT_FALSE(SpotDrawing(stage.scenery(), lens, Pose(), 0.05, 5.0).draw(&spots[2400], 4)) << "rays are quicker";
  for (std::size_t i = 0; i < spots.size(); ++i) ASSERT_EQ(spots[i].near, before[i].near);
}

}  // namespace
}  // namespace bin_scenes
