#include "bin_scenes/part/distance_field.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/core/random.hpp"
#include "bin_scenes/part/mesh_query.hpp"
#include "part/closed_forms.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace bin_scenes::test {
namespace {

FieldOptions with_cell(double cell) {
  FieldOptions options;
  options.cell = cell;
  return options;
}

Vec3 node_position(const DistanceField& field, int x, int y, int z) {
  return field.origin + field.cell * Vec3(x, y, z);
}

/// Calls visit(position, value) for every node.
void for_each_node(const DistanceField& field, const std::function<void(const Vec3&, double)>& visit) {
  for (int z = 0; z < field.nodes[2]; ++z)
    for (int y = 0; y < field.nodes[1]; ++y)
      for (int x = 0; x < field.nodes[0]; ++x) visit(node_position(field, x, y, z), field.at(x, y, z));
}

/// Largest |interpolated - exact| over random points at most `reach` from the surface.
double interpolation_error(const DistanceField& field, const std::function<double(const Vec3&)>& exact, double reach) {
  Random random(1, 0, Stream::probe);
  const Vec3 size = field.cell * Vec3(field.nodes[0] - 1, field.nodes[1] - 1, field.nodes[2] - 1);
  double worst = 0;
  int used = 0;
  while (used < 5000) {
    const Vec3 p = field.origin + size.cwiseProduct(Vec3(random.uniform(), random.uniform(), random.uniform()));
    if (std::abs(exact(p)) > reach) continue;
    worst = std::max(worst, std::abs(field.distance(p) - exact(p)));
    ++used;
  }
  return worst;
}

TEST(DistanceField, EveryNodeOfABoxIsExact) {
  const Vec3 half(0.03, 0.02, 0.01);
  const DistanceField field = distance_field(box_mesh(2 * half), with_cell(0.02));
  for_each_node(field, [&](const Vec3& p, double value) { ASSERT_NEAR(value, box_distance(half, p), 1e-8); });
}

TEST(DistanceField, NodesNearATorusAreExactAndFarOnesNeverTooSmall) {
  const Mesh mesh = torus_mesh(0.04, 0.012, 96, 40);
  const MeshQuery query(mesh);
  const DistanceField field = distance_field(query, with_cell(0.015));
  double worst = 0, sum = 0;
  std::size_t far = 0;
  for_each_node(field, [&](const Vec3& p, double value) {
    const double exact = query.signed_distance(p);
    ASSERT_GT(std::abs(value), std::abs(exact) - 1e-8);
    if (std::abs(exact) < 3 * field.cell) {
      ASSERT_NEAR(value, exact, 1e-8);
    } else {
      worst = std::max(worst, std::abs(value - exact));
      sum += std::abs(value - exact);
      ++far;
    }
  });
  EXPECT_LT(worst, 0.5 * field.cell);
  EXPECT_LT(sum / far, 0.01 * field.cell);
}

// Away from edges the trilinear error is second order: (curvature / 8) cell^2 an axis.
TEST(DistanceField, InterpolationErrorOfASphereFallsWithTheSquareOfTheCell) {
  const double radius = 0.05;
  const Mesh mesh = sphere_mesh(radius, 6);  // its own facets are 4e-5 radius off the sphere
  const auto exact = [&](const Vec3& p) { return p.norm() - radius; };
  const DistanceField coarse = distance_field(mesh, with_cell(0.04)), fine = distance_field(mesh, with_cell(0.02));
  const double coarse_error = interpolation_error(coarse, exact, coarse.cell);
  const double fine_error = interpolation_error(fine, exact, fine.cell);
  EXPECT_LT(coarse_error, 2.0 / 8 * coarse.cell * coarse.cell / (0.7 * radius));
  EXPECT_GT(coarse_error / fine_error, 3.3);
}

TEST(DistanceField, TorusAgreesWithTheClosedForm) {
  const double major = 0.04, minor = 0.015;
  const Mesh mesh = torus_mesh(major, minor, 400, 160);
  const auto exact = [&](const Vec3& p) { return torus_distance(major, minor, p); };
  const DistanceField field = distance_field(mesh, with_cell(0.01));
  EXPECT_LT(interpolation_error(field, exact, field.cell), 0.25 * field.cell * field.cell / (0.8 * minor));
}

TEST(DistanceField, CavityOfAHollowBoxIsOutside) {
  const Vec3 outer = Vec3::Constant(0.03), inner = Vec3::Constant(0.025);
  const Mesh mesh = joined(box_mesh(2 * outer), inverted(box_mesh(2 * inner)));
  const DistanceField field = distance_field(mesh, with_cell(0.02));
  for_each_node(field, [&](const Vec3& p, double value) {
    const double exact = std::max(box_distance(outer, p), -box_distance(inner, p));
    if (std::abs(exact) > 1e-9) {
      ASSERT_EQ(value < 0, exact < 0) << p.transpose();
    }
  });
  EXPECT_NEAR(field.distance(Vec3::Zero()), 0.025, 0.51 * field.cell);  // the centre is a peak between nodes
}

// A wall much thinner than a cell: no node lies in it, and the cavity behind it is still outside, the core inside.
TEST(DistanceField, SignSurvivesWallsThinnerThanACell) {
  const Mesh mesh = joined(joined(box_mesh(Vec3::Constant(0.06)), inverted(box_mesh(Vec3::Constant(0.0598)))),
                           box_mesh(Vec3::Constant(0.02)));
  const DistanceField field = distance_field(mesh, with_cell(0.03));
  EXPECT_GT(field.distance(Vec3(0.02, 0.02, 0)), 0);
  EXPECT_GT(field.distance(Vec3(0.032, 0, 0)), 0);
  EXPECT_LT(field.distance(Vec3::Zero()), 0);
}

// Rows of nodes run along edges and through vertices of an aligned mesh, and through buried walls of shells that
// overlap.
TEST(DistanceField, SignOfEveryNodeIsThatOfTheWindingNumber) {
  const Mesh aligned = box_mesh(Vec3(0.06, 0.04, 0.02));
  Mesh turned = torus_mesh(0.04, 0.012, 24, 10);
  for (Vec3& v : turned.vertices) v = Quat(0.8, 0.3, -0.4, 0.33).normalized() * v;
  for (const Mesh& mesh : {aligned, turned, joined(aligned, moved(turned, Vec3(0.01, 0, 0))),
                           joined(aligned, box_mesh(Vec3::Constant(0.03), Vec3(0.03, 0.01, 0)))}) {
    const MeshQuery query(mesh);
    const DistanceField field = distance_field(query, with_cell(0.02));
    std::size_t wrong = 0;
    for_each_node(field, [&](const Vec3& p, double value) {
      if (std::abs(value) > 1e-9) wrong += (value < 0) != query.inside(p);
    });
    EXPECT_EQ(wrong, 0u) << "of " << field.values.size();
  }
}

TEST(DistanceField, OpenMeshTakesItsSignNodeByNode) {
  Mesh mesh = box_mesh(Vec3::Constant(0.06));
  mesh.triangles.erase(mesh.triangles.begin() + 2, mesh.triangles.begin() + 4);  // the lid at +z
  const MeshQuery query(mesh);
  const DistanceField field = distance_field(query, with_cell(0.03));
  std::size_t wrong = 0, count = 0;
  for_each_node(field, [&](const Vec3& p, double value) {
    if (std::abs(p.x()) > 0.04 || std::abs(p.y()) > 0.04 || std::abs(p.z()) > 0.032) return;
    wrong += (value < 0) != query.inside(p);
    ++count;
  });
  EXPECT_EQ(wrong, 0u) << "of " << count;
}

TEST(DistanceField, NormalIsTheOutwardUnitGradient) {
  const double radius = 0.05;
  const DistanceField field = distance_field(sphere_mesh(radius, 5), with_cell(0.01));
  Random random(2, 0, Stream::probe);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 direction = random.orientation() * Vec3::UnitX();
    const Vec3 normal = field.normal(radius * random.uniform(0.97, 1.03) * direction);
    ASSERT_NEAR(normal.norm(), 1.0, 1e-9);
    ASSERT_GT(normal.dot(direction), std::cos(0.04));  // half a cell diagonal and half a facet, / radius
  }
}

TEST(DistanceField, OutsideTheGridTheWayToTheGridIsAdded) {
  const Vec3 half(0.03, 0.02, 0.01);
  const DistanceField field = distance_field(box_mesh(2 * half), with_cell(0.02));
  EXPECT_NEAR(field.distance(Vec3(0.5, 0, 0)), 0.47, 1e-6);
}

TEST(DistanceField, NodeLimitMakesTheCellGrowAndSaysSo) {
  FieldOptions options = with_cell(0.002);
  options.max_nodes = 30000;
  const DistanceField field = distance_field(sphere_mesh(0.05, 2), options);
  EXPECT_TRUE(field.coarsened);
  EXPECT_LE(field.values.size(), options.max_nodes);
  EXPECT_GT(field.values.size(), options.max_nodes / 2);
  EXPECT_FALSE(distance_field(sphere_mesh(0.05, 2), with_cell(0.02)).coarsened);
}

TEST(DistanceField, DegenerateTrianglesDoNoHarm) {
  Mesh mesh = box_mesh(Vec3::Constant(0.06));
  mesh.triangles.push_back({0, 0, 1});
  mesh.triangles.push_back({2, 2, 2});
  mesh.vertices.push_back(0.5 * (mesh.vertices[0] + mesh.vertices[1]));
  mesh.triangles.push_back({0, 1, 8});
  const DistanceField field = distance_field(mesh, with_cell(0.03));
  for_each_node(field,
                [&](const Vec3& p, double value) { ASSERT_NEAR(value, box_distance(Vec3::Constant(0.03), p), 1e-8); });
}

TEST(DistanceField, SameMeshGivesTheSameBits) {
  const Mesh mesh = torus_mesh(0.04, 0.015, 40, 20);
  EXPECT_EQ(distance_field(mesh, with_cell(0.02)).values, distance_field(mesh, with_cell(0.02)).values);
}

TEST(DistanceField, NonsenseIsRefused) {
  EXPECT_THROW(distance_field(Mesh{}, {}), Error);
  EXPECT_THROW(distance_field(box_mesh(Vec3::Ones()), with_cell(0)), Error);
  EXPECT_THROW(distance_field(box_mesh(Vec3::Ones()), with_cell(-1)), Error);
}

}  // namespace
}  // namespace bin_scenes::test
