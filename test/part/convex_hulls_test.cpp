#include "bin_scenes/part/convex_hulls.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/core/random.hpp"
#include "bin_scenes/part/hull_geometry.hpp"
#include "bin_scenes/part/mass_properties.hpp"
#include "bin_scenes/part/mesh_query.hpp"
#include "part/closed_forms.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>

namespace bin_scenes::test {
namespace {

void expect_closed_and_convex(const Mesh& hull) {
  const HullPlanes planes(hull);
  const double size = hull.bounds().diagonal();
  for (const Vec3& v : hull.vertices) EXPECT_LT(planes.outside(v), 2e-4 * size);
  EXPECT_EQ(hull.vertices.size() + hull.triangles.size(), hull.triangles.size() * 3 / 2 + 2);  // Euler
  EXPECT_GT(mass_properties(hull).volume, 0);
}

TEST(ConvexHull, OfACubeWithPointsInsideIsTheCube) {
  Mesh cube = box_mesh(Vec3::Constant(0.05));
  cube.vertices.push_back(Vec3(0.01, 0, 0));
  cube.vertices.push_back(Vec3(0.025, 0, 0));  // on a face
  const Mesh hull = convex_hull(cube.vertices, 64);
  expect_closed_and_convex(hull);
  EXPECT_EQ(hull.vertices.size(), 8u);
  EXPECT_NEAR(mass_properties(hull).volume, std::pow(0.05, 3), 1e-12);
}

TEST(ConvexHull, KeepsToTheVertexLimit) {
  const Mesh sphere = sphere_mesh(0.05, 4);
  const Mesh hull = convex_hull(sphere.vertices, 64);
  expect_closed_and_convex(hull);
  EXPECT_LE(hull.vertices.size(), 64u);
  EXPECT_GT(mass_properties(hull).volume, 0.8 * mass_properties(sphere).volume);
}

TEST(ConvexHull, OfFlatPointsIsEmpty) {
  EXPECT_TRUE(convex_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0.5, 0.2, 0}}, 64).empty());
  EXPECT_TRUE(convex_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, 64).empty());
}

TEST(ExtremePoints, ReachAsFarAsAllInEveryDirection) {
  Random random(1, 0, Stream::probe);
  Mesh dented = sphere_mesh(0.05, 4);  // its facets meet at angles that the computer of hulls rounds away
  for (Vec3& x : dented.vertices)
    if (x.x() > 0.02) x.x() = 0.02;
  for (const Mesh& mesh : {dented, box_mesh(Vec3(0.06, 0.04, 0.02)), prism_mesh(0.02, 0.05, 24)}) {
    const std::vector<Vec3> extreme = extreme_points(mesh.vertices);
    EXPECT_LE(extreme.size(), mesh.vertices.size());
    for (int k = 0; k < 200; ++k) {
      const Vec3 direction = random.orientation() * Vec3::UnitX();
      const auto reach = [&](const std::vector<Vec3>& points) {
        double most = -1.0;
        for (const Vec3& x : points) most = std::max(most, direction.dot(x));
        return most;
      };
      EXPECT_EQ(reach(extreme), reach(mesh.vertices));
    }
  }
  const std::vector<Vec3> flat{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  EXPECT_EQ(extreme_points(flat).size(), 3u);
}

TEST(ConvexHulls, ConvexPartIsOneHullWithoutError) {
  for (const Mesh& mesh : {box_mesh(Vec3(0.06, 0.04, 0.02)), prism_mesh(0.02, 0.05, 24)}) {
    const ConvexHulls hulls = convex_hulls(mesh);
    EXPECT_EQ(hulls.hulls.size(), 1u);
    EXPECT_TRUE(hulls.met);
    EXPECT_LT(hulls.surface_error, 1e-3);
    EXPECT_NEAR(hulls.volume_error, 0.0, 1e-6);
  }
}

// 64 vertices leave a ball by more than 1 % of its diagonal; cut into pieces it would take most of a minute.
TEST(ConvexHulls, ABallOfManyFacetsIsOneHullOfMoreVertices) {
  const ConvexHulls hulls = convex_hulls(sphere_mesh(0.02, 6));
  EXPECT_TRUE(hulls.met);
  ASSERT_EQ(hulls.hulls.size(), 1u);
  EXPECT_LT(hulls.surface_error, 0.01);
  EXPECT_LE(hulls.hulls[0].vertices.size(), 512u);
}

TEST(ConvexHulls, LIsExactlyTwoHulls) {
  const ConvexHulls hulls = convex_hulls(l_mesh(1.0));
  EXPECT_TRUE(hulls.met) << hulls.surface_error;
  EXPECT_EQ(hulls.hulls.size(), 2u);
  EXPECT_LT(hulls.surface_error, 1e-9);
  double sum = 0;
  for (const Mesh& hull : hulls.hulls) sum += mass_properties(hull).volume;
  EXPECT_NEAR(sum, 3.0, 1e-9);  // they share no volume
  for (const Mesh& hull : hulls.hulls) expect_closed_and_convex(hull);
}

TEST(ConvexHulls, ThreeOverlappingBoxesAreThreeHulls) {
  const Mesh u =
      joined(joined(box_mesh(Vec3(0.06, 0.02, 0.01)), box_mesh(Vec3(0.01, 0.02, 0.05), Vec3(-0.025, 0, 0.02))),
             box_mesh(Vec3(0.01, 0.02, 0.05), Vec3(0.025, 0, 0.02)));
  const ConvexHulls hulls = convex_hulls(u);
  EXPECT_TRUE(hulls.met) << hulls.surface_error;
  EXPECT_EQ(hulls.hulls.size(), 3u);
}

/// A ring of prisms about z.
Mesh ring_of_prisms(double inner, double outer, double height, std::uint32_t sides) {
  Mesh ring;
  for (std::uint32_t i = 0; i < sides; ++i) {
    const double u = 2 * M_PI * i / sides;
    for (const double r : {inner, outer}) {
      for (const double z : {0.0, height}) ring.vertices.push_back({r * std::cos(u), r * std::sin(u), z});
    }
    const std::uint32_t a = 4 * i, b = 4 * ((i + 1) % sides);
    const auto quad = [&](std::uint32_t p, std::uint32_t q, std::uint32_t r, std::uint32_t s) {
      ring.triangles.push_back({p, q, r});
      ring.triangles.push_back({p, r, s});
    };
    quad(a + 2, b + 2, b, a);          // inner wall, top to bottom
    quad(a + 1, b + 1, b + 3, a + 3);  // outer wall
    quad(a + 3, b + 3, b + 2, a + 2);  // top
    quad(a, b, b + 1, a + 1);          // bottom
  }
  return inverted(ring);
}

// Neither one cut through a ring nor one through the hole of a plate makes its hulls smaller; two do.
TEST(ConvexHulls, RingOfPrismsKeepsItsHole) {
  constexpr std::uint32_t sides = 24;
  const Mesh ring = ring_of_prisms(0.02, 0.03, 0.01, sides);
  ASSERT_NEAR(mass_properties(ring).volume, 0.01 * 12 * std::sin(2 * M_PI / sides) * (9e-4 - 4e-4), 1e-12);
  const ConvexHulls hulls = convex_hulls(ring);
  EXPECT_TRUE(hulls.met) << hulls.surface_error;
  EXPECT_LE(hulls.hulls.size(), 24u);
  EXPECT_NEAR(hulls.volume_error, 0.0, 0.05);
  for (const Mesh& hull : hulls.hulls) EXPECT_GT(HullPlanes(hull).outside(Vec3(0, 0, 0.005)), 0.018);
}

/// Largest depth of points of the largest cylinder about z inside a hole of `sides` facets in any hull / radius.
double depth_in_hole(const ConvexHulls& hulls, double radius, double from, double to, std::uint32_t sides) {
  double most = -1;
  const double free = radius * std::cos(M_PI / sides);
  for (const Mesh& hull : hulls.hulls) {
    const HullPlanes planes(hull);
    for (int i = 0; i < 360; ++i)
      for (const double share : {0.05, 0.5, 0.95}) {
        const double u = M_PI * i / 180;
        most = std::max(most, -planes.outside({free * std::cos(u), free * std::sin(u), from + share * (to - from)}));
      }
  }
  return most / radius;
}

// With chords across the hole, a peg with 0.3 mm of play stuck in a ring.
TEST(ConvexHulls, NoneIsInsideARoundHole) {
  for (const double size : {0.1, 1.0, 6.0})
    for (const std::uint32_t sides : {24u, 48u, 96u})
      for (const double outer : {0.023, 0.03, 0.06}) {
        const ConvexHulls hulls = convex_hulls(ring_of_prisms(size * 0.02, size * outer, size * 0.015, sides));
        EXPECT_TRUE(hulls.met) << hulls.surface_error;
        EXPECT_LT(depth_in_hole(hulls, size * 0.02, 0, size * 0.015, sides), 2e-4)
            << size << " times, " << sides << " sides, outer radius " << outer << ", " << hulls.hulls.size();
      }
}

// A cup: the hole ends at its bottom, which stays.
TEST(ConvexHulls, ABlindHoleKeepsItsBottom) {
  constexpr std::uint32_t sides = 48;
  Mesh cup;
  for (const auto& [r, z] :
       {std::pair(0.02, 0.004), std::pair(0.02, 0.03), std::pair(0.024, 0.03), std::pair(0.024, 0.0)})
    for (std::uint32_t i = 0; i < sides; ++i)
      cup.vertices.push_back({r * std::cos(2 * M_PI * i / sides), r * std::sin(2 * M_PI * i / sides), z});
  cup.vertices.push_back({0, 0, 0.004});
  cup.vertices.push_back({0, 0, 0});
  for (std::uint32_t i = 0; i < sides; ++i) {
    const std::uint32_t j = (i + 1) % sides;
    cup.triangles.push_back({4 * sides, i, j});
    for (std::uint32_t k = 0; k < 3; ++k) {
      cup.triangles.push_back({k * sides + i, (k + 1) * sides + i, (k + 1) * sides + j});
      cup.triangles.push_back({k * sides + i, (k + 1) * sides + j, k * sides + j});
    }
    cup.triangles.push_back({4 * sides + 1, 3 * sides + j, 3 * sides + i});
  }
  ASSERT_GT(mass_properties(cup).volume, 0);
  const ConvexHulls hulls = convex_hulls(cup);
  EXPECT_TRUE(hulls.met) << hulls.surface_error;
  EXPECT_LT(depth_in_hole(hulls, 0.02, 0.005, 0.03, sides), 2e-4) << hulls.hulls.size();
  EXPECT_EQ(std::count_if(hulls.hulls.begin(), hulls.hulls.end(),
                          [](const Mesh& hull) {
                            return HullPlanes(hull).outside({0, 0, 0.002}) < 0;
                          }),
            1);
}

// Hulls of real parts have slivers, whose normals mean nothing; their planes must not cut into the hull.
TEST(HullPlanes, SliversCutNothingOff) {
  Mesh box = box_mesh(Vec3::Constant(0.05));
  box.vertices.push_back(0.5 * (box.vertices[0] + box.vertices[1]) + Vec3(0, 1e-19, -1e-18));
  box.triangles.push_back({0, 1, 8});
  const HullPlanes planes(box);
  for (const Vec3& v : box.vertices) EXPECT_LT(planes.outside(0.999 * v), 0.0);
}

TEST(ConvexHulls, TorusStaysOpenInTheMiddle) {
  HullOptions options;
  options.max_error = 0.03;
  options.max_volume_error = 1.0;
  const ConvexHulls hulls = convex_hulls(torus_mesh(0.04, 0.012, 32, 12), options);
  EXPECT_TRUE(hulls.met) << hulls.surface_error;
  EXPECT_GE(hulls.hulls.size(), 5u);
  EXPECT_LE(hulls.hulls.size(), 24u);
  for (const Mesh& hull : hulls.hulls) EXPECT_GT(HullPlanes(hull).outside(Vec3::Zero()), 0.015);
}

// A thin ring of few hulls is near everywhere, and yet too large.
TEST(ConvexHulls, VolumeGoalTakesMoreHullsThanTheSurface) {
  const Mesh ring = torus_mesh(0.04, 0.003, 96, 12);
  HullOptions options;
  options.max_volume_error = 1.0;
  const ConvexHulls near = convex_hulls(ring, options);
  EXPECT_TRUE(near.met);
  EXPECT_LE(near.surface_error, 0.01);
  EXPECT_GT(near.volume_error, 0.05);
  options.max_volume_error = 0.05;
  const ConvexHulls both = convex_hulls(ring, options);
  EXPECT_TRUE(both.met);
  EXPECT_LE(both.surface_error, 0.01);
  EXPECT_LE(both.volume_error, 0.05);
  EXPECT_GT(both.hulls.size(), near.hulls.size());
  options.max_hulls = static_cast<int>(near.hulls.size());
  EXPECT_FALSE(convex_hulls(ring, options).met);
}

TEST(ConvexHulls, UnreachableGoalIsSaid) {
  HullOptions options;
  options.max_hulls = 2;
  options.max_error = 0.001;
  const ConvexHulls hulls = convex_hulls(torus_mesh(0.04, 0.012, 24, 8), options);
  EXPECT_FALSE(hulls.met);
  EXPECT_LE(hulls.hulls.size(), 2u);
  EXPECT_GT(hulls.surface_error, 0.001);
}

// Caps fanned out from a corner between two teeth lie over each other. Slices without volume were cut off them for
// ever.
TEST(ConvexHulls, OfAGearWhoseCapsOverlapThemselvesEnd) {
  constexpr std::uint32_t corners = 40;
  Mesh gear;
  for (const double z : {-0.005, 0.005})
    for (std::uint32_t k = 0; k < corners; ++k) {
      const double angle = 2.0 * M_PI * k / corners, radius = std::cos(10.0 * angle) > 0.0 ? 0.02 : 0.017;
      gear.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
    }
  for (std::uint32_t k = 0; k < corners; ++k) {
    const std::uint32_t next = (k + 1) % corners;
    gear.triangles.push_back({k, next, corners + next});
    gear.triangles.push_back({k, corners + next, corners + k});
    if (k < 2) continue;
    gear.triangles.push_back({0, k, k - 1});
    gear.triangles.push_back({corners, corners + k - 1, corners + k});
  }
  const ConvexHulls hulls = convex_hulls(gear, {});
  EXPECT_GE(hulls.hulls.size(), 10u);
  EXPECT_LE(hulls.surface_error, 0.02);
}

TEST(ConvexHulls, ObjHasAnObjectPerHull) {
  ConvexHulls hulls;
  hulls.hulls = {box_mesh(Vec3::Constant(0.05)), box_mesh(Vec3::Constant(0.02), Vec3(0.1, 0, 0))};
  const std::string path = testing::TempDir() + "hulls.obj";
  write_hulls_obj(hulls, path);
  std::ifstream file(path);
  std::string line;
  int objects = 0, vertices = 0, faces = 0, highest = 0;
  while (std::getline(file, line)) {
    objects += line.rfind("o ", 0) == 0;
    vertices += line.rfind("v ", 0) == 0;
    int a, b, c;
    if (std::sscanf(line.c_str(), "f %d %d %d", &a, &b, &c) == 3) ++faces, highest = std::max({highest, a, b, c});
  }
  EXPECT_EQ(objects, 2);
  EXPECT_EQ(vertices, 16);
  EXPECT_EQ(faces, 24);
  EXPECT_EQ(highest, 16);
  std::remove(path.c_str());
  EXPECT_THROW(write_hulls_obj(hulls, "/nonexistent/hulls.obj"), Error);
}

}  // namespace
}  // namespace bin_scenes::test
