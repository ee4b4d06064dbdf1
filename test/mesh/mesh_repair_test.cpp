#include "mesh_repair.hpp"

#include "part/shapes.hpp"

#include <gtest/gtest.h>

namespace bin_scenes {
namespace {

using namespace test;
using namespace repair;

/// Every triangle with vertices of its own, as an STL file has it.
Mesh soup(const Mesh& mesh) {
  Mesh result;
  for (const Triangle& t : mesh.triangles) {
    const auto base = static_cast<std::uint32_t>(result.vertices.size());
    for (const std::uint32_t v : t) result.vertices.push_back(mesh.vertices[v]);
    result.triangles.push_back({base, base + 1, base + 2});
  }
  return result;
}

TEST(MeshRepair, WeldingMakesASoupASurface) {
  Mesh mesh = soup(box_mesh({1, 2, 3}));
  EXPECT_EQ(open_edges(mesh), 36u);
  const Welded welded = weld(mesh, 1e-6);
  EXPECT_EQ(welded.vertices, 28u);
  EXPECT_EQ(welded.triangles, 0u);
  EXPECT_EQ(mesh.vertices.size(), 8u);
  EXPECT_EQ(open_edges(mesh), 0u);
}

TEST(MeshRepair, WeldingReachesAcrossCellsOfTheGridAndNoFurther) {
  // Pairs at every offset along the grid: none may be missed for lying on two sides of a cell's border.
  const double tolerance = 1e-3;
  for (int i = 0; i < 400; ++i) {
    const double x = 1e-4 * i + 0.1;
    Mesh mesh;
    mesh.vertices = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(x, 1, 0), Vec3(x + 0.99e-3, 1, 0), Vec3(x + 3e-3, 1, 0)};
    mesh.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}};
    weld(mesh, tolerance);
    ASSERT_EQ(mesh.vertices.size(), 4u) << x;
    ASSERT_EQ(mesh.triangles[0], mesh.triangles[1]);
    ASSERT_NE(mesh.triangles[0], mesh.triangles[2]);
  }
}

TEST(MeshRepair, CollapsedTrianglesOpenNoHole) {
  Mesh mesh = sphere_mesh(1.0, 2);
  mesh.vertices[mesh.triangles[5][1]] = mesh.vertices[mesh.triangles[5][0]];
  const Welded welded = weld(mesh, 1e-6);
  EXPECT_EQ(welded.triangles, 2u);  // both sides of the collapsed edge
  EXPECT_EQ(open_edges(mesh), 0u);
}

TEST(MeshRepair, ASliverGivesWayToASplitEdge) {
  // Side 0-1 of the box's bottom gets a vertex in its middle on one side; a triangle without area closes the gap.
  Mesh mesh = box_mesh({2, 2, 2});
  mesh.vertices.push_back({0, -1, -1});
  mesh.triangles[1] = {0, 3, 8};
  mesh.triangles.push_back({8, 3, 1});
  mesh.triangles.push_back({0, 8, 1});
  ASSERT_EQ(open_edges(mesh), 0u);
  EXPECT_EQ(remove_slivers(mesh, 1e-6), 1u);
  EXPECT_EQ(open_edges(mesh), 3u);
  EXPECT_EQ(split_t_junctions(mesh, 1e-6), 1u);
  EXPECT_EQ(open_edges(mesh), 0u);
  EXPECT_NEAR(signed_volume(mesh), 8.0, 1e-12);
}

TEST(MeshRepair, LongEdgesAreSplitAtEveryVertexOnThem) {
  // Two halves of a box; the upper half's lower rim is cut finely, the lower half's upper rim is not.
  Mesh mesh = box_mesh({1, 1, 1});
  mesh.triangles.erase(mesh.triangles.begin() + 2, mesh.triangles.begin() + 4);  // no top
  const int steps = 7;
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const Vec3 corners[] = {{-.5, -.5, .5}, {.5, -.5, .5}, {.5, .5, .5}, {-.5, .5, .5}};
  for (int side = 0; side < 4; ++side) {
    for (int i = 0; i < steps; ++i) {
      const double u = static_cast<double>(i) / steps;
      mesh.vertices.push_back((1 - u) * corners[side] + u * corners[(side + 1) % 4]);
    }
  }
  mesh.vertices.push_back({0, 0, 1});
  const auto apex = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  for (std::uint32_t i = 0; i < 4 * steps; ++i) {
    mesh.triangles.push_back({first + i, first + (i + 1) % (4 * steps), apex});
  }
  weld(mesh, 1e-9);
  EXPECT_GT(open_edges(mesh), 0u);
  EXPECT_EQ(split_t_junctions(mesh, 1e-9), 4u * (steps - 1));
  EXPECT_EQ(open_edges(mesh), 0u);
  EXPECT_NEAR(signed_volume(mesh), 1.0 + 0.5 / 3.0, 1e-12);
}

TEST(MeshRepair, DuplicatesOfOneSideAndOfBoth) {
  Mesh twice = box_mesh({1, 1, 1});
  append(twice, box_mesh({1, 1, 1}));
  weld(twice, 1e-9);
  const Duplicates same = remove_duplicates(twice, false);
  EXPECT_EQ(same.same, 12u);
  EXPECT_EQ(same.opposite_pairs, 0u);
  EXPECT_EQ(open_edges(twice), 0u);
  EXPECT_NEAR(signed_volume(twice), 1.0, 1e-14);

  Mesh both = box_mesh({1, 1, 1});
  append(both, inverted(box_mesh({1, 1, 1})));
  weld(both, 1e-9);
  Mesh one_side = both;
  EXPECT_EQ(remove_duplicates(both, false).opposite_pairs, 12u);
  EXPECT_TRUE(both.empty());
  remove_duplicates(one_side, true);
  EXPECT_EQ(one_side.triangles.size(), 12u);
}

TEST(MeshRepair, WindingFollowsTheMajority) {
  Mesh mesh = sphere_mesh(1.0, 2);
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
  EXPECT_GT(open_edges(mesh), 0u);
  const Agreement agreement = agree_winding(mesh);
  EXPECT_EQ(agreement.turned, (mesh.triangles.size() + 2) / 3);
  EXPECT_EQ(agreement.conflicts, 0u);
  EXPECT_EQ(open_edges(mesh), 0u);
  EXPECT_GT(signed_volume(mesh), 0.0);
}

TEST(MeshRepair, AMoebiusStripHasNoOutside) {
  Mesh mesh;
  const std::uint32_t n = 20;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double u = 2 * M_PI * i / n;
    for (const double w : {-0.2, 0.2}) {
      const double r = 1 + w * std::cos(u / 2);
      mesh.vertices.push_back({r * std::cos(u), r * std::sin(u), w * std::sin(u / 2)});
    }
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t a = 2 * i, b = a + 1;
    const bool last = i + 1 == n;
    const std::uint32_t c = last ? 1 : a + 2, d = last ? 0 : a + 3;  // the ends meet crosswise
    mesh.triangles.push_back({a, b, d});
    mesh.triangles.push_back({a, d, c});
  }
  EXPECT_GT(agree_winding(mesh).conflicts, 0u);
}

TEST(MeshRepair, HolesAreClosedByLeastArea) {
  for (const std::size_t missing : {1u, 5u}) {
    Mesh mesh = sphere_mesh(1.0, 3);
    mesh.triangles.resize(mesh.triangles.size() - missing);
    const double before = signed_volume(sphere_mesh(1.0, 3));
    const std::size_t holes = boundary_loops(mesh).size();
    EXPECT_GE(holes, 1u);
    EXPECT_EQ(close_holes(mesh, 10.0).small, holes);
    EXPECT_EQ(open_edges(mesh), 0u);
    EXPECT_NEAR(signed_volume(mesh), before, 0.01);
  }
  // A concave hole in a plane: the top of an L. Any other filling than the L itself has more area.
  Mesh open = l_mesh(1.0);
  Mesh walls = open;
  walls.triangles.clear();
  for (const Triangle& t : open.triangles) {
    if (open.vertices[t[0]].z() + open.vertices[t[1]].z() + open.vertices[t[2]].z() < 3.0) walls.triangles.push_back(t);
  }
  ASSERT_EQ(boundary_loops(walls).size(), 1u);
  close_holes(walls, 100.0);
  EXPECT_NEAR(area(walls), area(open), 1e-12);
  EXPECT_NEAR(signed_volume(walls), 3.0, 1e-12);
}

TEST(MeshRepair, LargeHolesStayUnlessHiddenInAnotherShell) {
  Mesh open_box = box_mesh({1, 1, 1});
  open_box.triangles.resize(10);  // without the face at x = 0.5
  Mesh alone = open_box;
  const Closed left = close_holes(alone, 0.5);
  EXPECT_EQ(left.small + left.hidden, 0u);
  EXPECT_EQ(open_edges(alone), 4u);
  EXPECT_EQ(alone.triangles.size(), 10u);

  append(open_box, box_mesh({2, 2, 2}, {1.2, 0, 0}));  // the opening lies inside this one
  EXPECT_EQ(close_holes(open_box, 0.5).hidden, 1u);
  EXPECT_EQ(open_edges(open_box), 0u);
}

TEST(MeshRepair, LoopsThatTouchInAVertexAreTwo) {
  Mesh mesh = sphere_mesh(1.0, 2);
  const std::uint32_t pole = 4;
  std::size_t removed = 0;  // two triangles at the pole with nothing else in common
  for (auto t = mesh.triangles.begin(); t != mesh.triangles.end();) {
    const bool at_pole = std::find(t->begin(), t->end(), pole) != t->end();
    const Vec3 middle = mesh.vertices[(*t)[0]] + mesh.vertices[(*t)[1]] + mesh.vertices[(*t)[2]];
    if (at_pole && middle.x() * middle.y() > 0.0) {
      t = mesh.triangles.erase(t);
      ++removed;
    } else {
      ++t;
    }
  }
  ASSERT_EQ(removed, 2u);
  const auto loops = boundary_loops(mesh);
  ASSERT_EQ(loops.size(), 2u);
  EXPECT_EQ(loops[0].size(), 3u);
  EXPECT_EQ(loops[1].size(), 3u);
}

TEST(MeshRepair, OutwardKeepsCavitiesAndTurnsWhatIsInsideOut) {
  Mesh hollow = box_mesh({4, 4, 4});
  append(hollow, inverted(box_mesh({2, 2, 2})));
  Mesh right = hollow;
  EXPECT_EQ(turn_outward(right), 0u);
  EXPECT_NEAR(signed_volume(right), 56.0, 1e-12);

  Mesh wrong = inverted(hollow);
  EXPECT_EQ(turn_outward(wrong), 24u);
  EXPECT_NEAR(signed_volume(wrong), 56.0, 1e-12);

  Mesh two = box_mesh({1, 1, 1});
  append(two, inverted(box_mesh({2, 2, 2}, {5, 0, 0})));
  EXPECT_EQ(turn_outward(two), 12u);
  EXPECT_NEAR(signed_volume(two), 9.0, 1e-12);
}

TEST(MeshRepair, AShellHasTheThicknessAskedFor) {
  const double thickness = 0.02;
  Mesh plate;
  plate.vertices = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 2, 0), Vec3(0, 2, 0)};
  plate.triangles = {{0, 1, 2}, {0, 2, 3}};
  thicken(plate, thickness);
  EXPECT_EQ(open_edges(plate), 0u);
  EXPECT_NEAR(signed_volume(plate), 2.0 * thickness, 1e-12);
  EXPECT_NEAR(plate.bounds().size().z(), thickness, 1e-15);

  // An open box: at its edges the offset grows, so that the walls keep their thickness.
  Mesh tray = box_mesh({1, 1, 1});
  tray.triangles.erase(tray.triangles.begin() + 2, tray.triangles.begin() + 4);
  thicken(tray, thickness);
  EXPECT_EQ(open_edges(tray), 0u);
  EXPECT_NEAR(signed_volume(tray), 5.0 * thickness, 5.0 * thickness * 0.03);
}

}  // namespace
}  // namespace bin_scenes
