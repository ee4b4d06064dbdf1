#include "solver/sphere/shapes/shape.hpp"
#include "bin_scenes/part/part_model.hpp"
#include "part/closed_forms.hpp"
#include "part/shapes.hpp"
#include "solver/sphere/make_world.hpp"
#include "solver/tight_scenes.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>

namespace bin_scenes::test {
namespace {

template <class T>
void expect_same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(T)), 0);
}

void expect_same(const sphere::Samples& a, const sphere::Samples& b) {
  expect_same_bytes(a.nodes, b.nodes);
  expect_same_bytes(a.cones, b.cones);
  expect_same_bytes(a.node_points, b.node_points);
  expect_same_bytes(a.edges, b.edges);
  expect_same_bytes(a.clusters, b.clusters);
  expect_same_bytes(a.first_edge, b.first_edge);
  expect_same_bytes(a.cluster_points, b.cluster_points);
  expect_same_bytes(a.cluster_radii, b.cluster_radii);
  expect_same_bytes(a.longest_edges, b.longest_edges);
  expect_same_bytes(a.edges_from, b.edges_from);
  EXPECT_EQ(a.extent, b.extent);
  EXPECT_EQ(a.spacing, b.spacing);
  EXPECT_EQ(a.face_spacing, b.face_spacing);
  EXPECT_EQ(a.sag, b.sag);
  EXPECT_EQ(a.radius, b.radius);
}

// 80 pins of 64 facets still trembled after 20 s; of 24, whose edges are sharp, they lay after eight.
TEST(NodesOnCurves, OfAPinStandAThirdOfItsRadiusApart) {
  const double radius = 1e-3;
  const PartModelPtr pin = PartModel::from_mesh(prism_mesh(radius, 0.06, 64), "pin");
  const sphere::Shape shape = sphere::make_shape(*pin, 200, 1000, 0.01);
  EXPECT_LT(shape.fine.face_spacing, 0.35 * radius);
  EXPECT_GT(shape.fine.face_spacing, 0.2 * radius);
}

TEST(NodesOnCurves, AreNoMoreWhereTheyLeanLittle) {
  const PartModelPtr drum = PartModel::from_mesh(prism_mesh(0.05, 0.06, 64), "drum");
  EXPECT_LT(sphere::make_shape(*drum, 200, 1000, 0.01).fine.nodes.size(), 2000u);
}

// Steps are cut by it: by half of it, twice as many were cut while pins were poured.
// With more edges than a cone has bounds, or edges too blunt to be sharp, a tip had the directions of one line that
// ends there.
TEST(Tips, OfAllSpikesPressInTheDirectionsOfEachFace) {
  for (const std::uint32_t sides : {3u, 4u, 6u, 8u, 24u, 48u}) {
    const PartModelPtr part = PartModel::from_mesh(testing::spike_mesh(sides, 0.03, 0.05), "spike");
    const sphere::Vec3f tip = -part->mass().center.cast<float>();
    const sphere::Shape shape = sphere::make_shape(*part, 200, 1000, 0.01);
    for (const sphere::Samples* samples : {&shape.coarse, &shape.fine}) {
      const auto at_tip = std::find_if(samples->nodes.begin(), samples->nodes.end(),
                                       [&](const sphere::Vec3f& node) { return (node - tip).norm() < 1e-6f; });
      ASSERT_NE(at_tip, samples->nodes.end()) << sides;
      const sphere::Cone& cone = samples->cones[static_cast<std::size_t>(at_tip - samples->nodes.begin())];
      EXPECT_NE(sphere::bounds_of(cone), 0u) << sides;
      for (std::size_t t = 0; t < part->mesh().triangles.size(); ++t) {
        sphere::Vec3f normal = part->mesh().area_vector(t).normalized().cast<float>();
        if (normal.z() > 0.5f) continue;  // of the base
        EXPECT_TRUE(sphere::turn_into_cone(cone, normal, 0.999f)) << sides << " sides, face " << t;
      }
    }
  }
}

TEST(Wall, OfASlenderPartIsHowThickItIs) {
  const double radius = 1e-3;
  const PartModelPtr pin = PartModel::from_mesh(prism_mesh(radius, 0.06, 64), "pin");
  const sphere::Shape shape = sphere::make_shape(*pin, 200, 1000, 0.01);
  EXPECT_NEAR(shape.wall, 2.0 * radius, 0.005 * radius);
  EXPECT_NEAR(shape.thickness, radius, 0.03 * radius);
  WorldDef def;
  def.parts = {pin};
  def.bodies.resize(1);
  const auto world = sphere::make_world(def, {}, [&](const PartModelPtr&) -> const sphere::Shape& { return shape; });
  EXPECT_EQ(world.thinnest, shape.wall);
  EXPECT_EQ(world.least_thickness, shape.thickness);
}

TEST(Wall, OfABlockIsNoMoreThanItsThickness) {
  const PartModelPtr block = PartModel::from_mesh(box_mesh(Vec3(0.05, 0.04, 0.03)), "block");
  const sphere::Shape shape = sphere::make_shape(*block, 50, 200, 0.02);
  EXPECT_EQ(shape.wall, shape.thickness);
}

TEST(Wall, OfASheetIsNoMoreThanItsThickness) {
  const PartModelPtr sheet = PartModel::from_mesh(box_mesh(Vec3(0.05, 0.04, 0.0006)), "sheet");
  const sphere::Shape shape = sphere::make_shape(*sheet, 50, 200, 0.02);
  EXPECT_EQ(shape.wall, shape.thickness);
}

TEST(ShapeFromTheCache, IsTheOneThatWasMade) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::temp_directory_path() / ("bin_scenes_shape_" + std::to_string(getpid()));
  setenv("XDG_CACHE_HOME", folder.c_str(), 1);
  const Mesh mesh = l_mesh(1.0);
  const auto one = PartModel::from_mesh(mesh, "one"), other = PartModel::from_mesh(mesh, "other");
  const std::size_t built_before = PartModel::work().built;
  const sphere::Shape made = sphere::make_shape(*one, 50, 200, 0.02);
  const std::size_t built = PartModel::work().built;
  EXPECT_GT(built, built_before);
  const sphere::Shape read = sphere::make_shape(*other, 50, 200, 0.02);
  EXPECT_EQ(PartModel::work().built, built) << "something was made twice";
  EXPECT_GT(made.fine.nodes.size(), made.coarse.nodes.size());
  expect_same(made.coarse, read.coarse);
  expect_same(made.fine, read.fine);
  EXPECT_EQ(read.wall, made.wall);
  // Other numbers of nodes are another shape.
  EXPECT_GT(sphere::make_shape(*other, 50, 4000, 0.02).fine.nodes.size(), made.fine.nodes.size());
  fs::remove_all(folder);
}

}  // namespace
}  // namespace bin_scenes::test
