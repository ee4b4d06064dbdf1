#include "bin_scenes/pour/pour.hpp"
#include "bin_scenes/pour/spawn.hpp"
#include "bin_scenes/solver/bullet_solver.hpp"
#include "pour/pour_plan.hpp"
#include "solver/fixture.hpp"

namespace bin_scenes::testing {

namespace {

PartModelPtr small_box() {
  static const PartModelPtr part = PartModel::from_mesh(box_mesh({0.05, 0.03, 0.02}), "box");
  return part;
}

/// The frame lies under its head, far from the centre of mass: a bolt that hangs on its head has the lowest origin.
PartModelPtr bolt() {
  static const PartModelPtr part = PartModel::from_mesh(
      merged(box_mesh({0.016, 0.016, 0.006}, {0, 0, -0.003}), box_mesh({0.008, 0.008, 0.04}, {0, 0, 0.02})), "bolt");
  return part;
}

double height_of_axis(const Quat& orientation) {
  return (orientation * Vec3::UnitZ()).z();
}

/// Of the height of the axis in ten equal classes, which are equally likely if orientations are uniform (Archimedes).
double chi_squared(const std::vector<double>& heights) {
  std::array<double, 10> counts{};
  for (const double z : heights) counts[std::min<std::size_t>(9, static_cast<std::size_t>(5.0 * (z + 1.0)))] += 1.0;
  const double expected = 0.1 * static_cast<double>(heights.size());
  double sum = 0.0;
  for (const double count : counts) sum += (count - expected) * (count - expected) / expected;
  return sum;
}

constexpr double unlikely = 27.9;  ///< chi-squared of nine degrees of freedom that one uniform sample of 1,000 exceeds

/// Four standard deviations of a binomial count.
double four_sigma(double count, double share) {
  return 4.0 * std::sqrt(count * share * (1.0 - share));
}

}  // namespace

TEST(Rain, StartsAreTurnedUniformly) {
  const Cover shape = cover(bolt()->mesh());
  Random random(5, 0, Stream::pour);
  std::vector<double> heights;
  for (int i = 0; i < 2000; ++i) {
    Rain rain({Vec3(-0.2, -0.15, 0), Vec3(0.2, 0.15, 0.2)}, 0.02);
    heights.push_back(height_of_axis(rain.place(*bolt(), shape, random, 12)->orientation));
  }
  EXPECT_LT(chi_squared(heights), unlikely);
}

TEST(Rain, PartsOfAHeapEnterTurnedUniformly) {
  Request request;
  request.bin.inner_size = Vec3(0.2, 0.15, 0.12);
  request.parts.emplace_back();
  request.parts[0].count = 100;
  std::vector<double> heights;
  RunHooks hooks;
  hooks.trace_rate = 60.0;  // Hz: a part falls freely, without turning, for 0.064 s
  for (const std::size_t index : {0, 1}) {
    std::vector<bool> seen(request.parts[0].count);
    hooks.trace = [&](std::size_t, double, const std::vector<BodyState>& states) {
      for (std::size_t b = 0; b < states.size(); ++b) {
        if (seen[b] || !states[b].pose.finite()) continue;
        seen[b] = true;
        heights.push_back(height_of_axis(states[b].pose.orientation));
      }
    };
    const auto solver = make_bullet_solver({});
    pour({request, {bolt()}}, *solver, {index}, hooks);
  }
  ASSERT_EQ(heights.size(), 200u) << "some never entered";
  EXPECT_LT(chi_squared(heights), unlikely);
}

TEST(Rain, WhatIsTooLongForTheBinIsTurnedUniformlyAmongWhatFits) {
  const PartModelPtr rod = PartModel::from_mesh(box_mesh({0.004, 0.004, 0.3}), "rod");
  const Cover shape = cover(rod->mesh());
  Rain rain({Vec3(-0.1, -0.1, 0), Vec3(0.1, 0.1, 1.0)}, 0.02);
  Random random(6, 0, Stream::pour), own(7, 0, Stream::pour);
  // Of rods that fit (0.3 m long, 0.2 m of floor), those that lean by less than 30 degrees.
  const double upright = std::cos(M_PI / 6.0);
  double fits = 0.0, steep = 0.0;
  while (fits < 100000.0) {
    const Vec3 axis = own.orientation() * Vec3::UnitZ();
    if (std::max(std::abs(axis.x()), std::abs(axis.y())) > 0.196 / 0.3) continue;  // less its thickness
    fits += 1.0;
    steep += std::abs(axis.z()) > upright;
  }
  const double share = steep / fits, count = 1000.0;
  double found = 0.0;
  for (int i = 0; i < static_cast<int>(count); ++i)
    found += std::abs(height_of_axis(rain.place(*rod, shape, random, 12)->orientation)) > upright;
  EXPECT_NEAR(found, count * share, four_sigma(count, share));
}

TEST(Rain, StartsClearOfEverything) {
  const Cover shape = cover(small_box()->mesh());
  Rain rain({Vec3(-0.1, -0.075, 0), Vec3(0.1, 0.075, 0.12)}, 0.02);
  Random random(5, 0, Stream::pour);
  std::vector<Pose> poses;
  for (int i = 0; i < 12; ++i)
    if (const auto pose = rain.place(*small_box(), shape, random, 20)) {
      poses.push_back(*pose);
      rain.add(shape, *pose, true);
    }
  ASSERT_GE(poses.size(), 6u);
  for (std::size_t a = 0; a < poses.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      for (const Cover::Ball& p : shape.balls)
        for (const Cover::Ball& q : shape.balls)
          EXPECT_GE((poses[a] * p.center - poses[b] * q.center).norm(), p.radius + q.radius - 1e-12);
}

/// A round bin leaves the corners of its box free: there parts would fall beside it.
TEST(Rain, NothingEntersBesideARoundBin) {
  const double outer = 0.124;
  const PartModelPtr drum = PartModel::from_mesh(ring_mesh(48, 0.12, outer, 0.2), "drum");
  const PartModelPtr grain = PartModel::from_mesh(box_mesh({0.005, 0.004, 0.003}), "grain");
  Request request;
  request.bin.kind = Bin::Kind::mesh;
  request.bin.mesh = "drum";
  request.parts.emplace_back();
  const PourPlan plan({request, {grain}, drum});
  const Cover shape = cover(grain->mesh());
  Random random(2, 0, Stream::pour);
  std::vector<Pose> starts = grid_poses(std::vector<const PartModel*>(500, grain.get()), plan.opening, 1.2, random);
  for (int i = 0; i < 500; ++i) {
    Rain rain(plan.opening, 0.02);
    if (const auto pose = rain.place(*grain, shape, random, 12)) starts.push_back(*pose);
  }
  EXPECT_GT(starts.size(), 950u);
  double farthest = 0.0;
  for (const Pose& start : starts)
    for (const Vec3& v : grain->mesh().vertices) farthest = std::max(farthest, (start * v).head<2>().norm());
  EXPECT_LT(farthest, outer);
  EXPECT_GT(farthest, 0.9 * outer) << "they enter all over it";
}

/// What Rain::place() finds, slowly: every ball against every ball, every vertex turned.
std::optional<Pose> lowest_of_tries(const Opening& opening, double drop, const PartModel& part, const Cover& shape,
                                    const std::vector<Pose>& present, Random& random, int tries) {
  std::optional<Pose> best;
  Pose pose;
  pose.orientation = random.orientation();  // a ring of this size fits in any orientation
  Aabb bounds;
  for (const Vec3& x : part.mesh().vertices) bounds.extend(Vec3(pose.orientation.toRotationMatrix() * x));
  const Vec3 lower = opening.lower - bounds.lower, upper = opening.upper - bounds.upper;
  for (int t = 0; t < tries; ++t) {
    const double u = random.uniform(), v = random.uniform();
    pose.position = {lower.x() + u * (upper.x() - lower.x()), lower.y() + v * (upper.y() - lower.y()), 0.0};
    double clear = lower.z();
    for (const Pose& other : present)
      for (const Cover::Ball& p : shape.balls)
        for (const Cover::Ball& q : shape.balls) {
          const Vec3 apart = other * p.center - pose * q.center;
          const double reach = p.radius + q.radius, beside = apart.head<2>().squaredNorm();
          if (beside < reach * reach) clear = std::max(clear, apart.z() + std::sqrt(reach * reach - beside));
        }
    pose.position.z() = clear + drop;
    if (clear + bounds.lower.z() <= opening.upper.z() && (!best || pose.position.z() < best->position.z())) best = pose;
  }
  return best;
}

TEST(Rain, FindsTheLowestPlaceOfAllTries) {
  const Opening opening{Vec3(-0.15, -0.1, 0), Vec3(0.15, 0.1, 0.12)};
  const PartModelPtr ring = PartModel::from_mesh(ring_mesh(24, 0.018, 0.0275, 0.012), "ring");
  const Cover shape = cover(ring->mesh());
  Rain rain(opening, 0.02);
  Random random(3, 0, Stream::pour), again(3, 0, Stream::pour);
  std::vector<Pose> present;
  for (int i = 0; i < 40; ++i) {
    const auto pose = rain.place(*ring, shape, random, 12);
    const auto expected = lowest_of_tries(opening, 0.02, *ring, shape, present, again, 12);
    ASSERT_EQ(pose.has_value(), expected.has_value());
    if (!pose) continue;
    EXPECT_NEAR((pose->position - expected->position).norm(), 0.0, 1e-15);
    EXPECT_EQ(pose->orientation.coeffs(), expected->orientation.coeffs());
    rain.add(shape, *pose, true);
    present.push_back(*pose);
  }
  EXPECT_GT(present.size(), 20u);
}

TEST(Cover, EnclosesEveryTriangle) {
  const Mesh mesh = ring_mesh(24, 0.018, 0.0275, 0.012);
  const Cover shape = cover(mesh);
  Random random(1, 0, Stream::probe);
  for (const auto& [a, b, c] : mesh.triangles)
    for (int k = 0; k < 20; ++k) {
      double u = random.uniform(), v = random.uniform();
      if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
      const Vec3 x =
          mesh.vertices[a] + u * (mesh.vertices[b] - mesh.vertices[a]) + v * (mesh.vertices[c] - mesh.vertices[a]);
      bool inside = false;
      for (const Cover::Ball& ball : shape.balls) inside = inside || (x - ball.center).norm() <= ball.radius + 1e-12;
      EXPECT_TRUE(inside);
    }
}

}  // namespace bin_scenes::testing
