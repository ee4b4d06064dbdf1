/// The passes of the sphere solver, each by itself against a closed form or a slow and obvious twin. The narrow phase
/// and the solve have files of their own.
#include "bin_scenes/core/cancel.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/core/random.hpp"
#include "boxes.hpp"
#include "solver/sphere/make_world.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

namespace bin_scenes::sphere {
namespace {

TEST(Shape, AThinPartMeetsOthersAsOneOfFiftyThicknesses) {
  PartModelPtr cube, needle;
  EXPECT_FLOAT_EQ(box_shape(cube, Vec3::Constant(0.05)).size, 0.05f * std::sqrt(3.0f));
  const Shape shape = box_shape(needle, Vec3(0.2, 0.001, 0.001));
  EXPECT_NEAR(shape.thickness, 5e-4f, 5e-6f);  // 2 volume / area
  EXPECT_FLOAT_EQ(shape.size, 50.0f * shape.thickness);
}

TEST(Shape, FieldOfABoxIsItsDistanceAwayFromKinks) {
  PartModelPtr part;
  const Shape shape = box_shape(part, {0.06, 0.04, 0.02});
  Vec3f gradient;
  EXPECT_NEAR(shape.field.sample({0, 0, 0.008f}, gradient), -0.002f, 1e-6f);
  EXPECT_NEAR((gradient - Vec3f::UnitZ()).norm(), 0, 1e-4f);
  EXPECT_NEAR(shape.field.sample({0.031f, 0.001f, 0.002f}, gradient), 0.001f, 1e-6f);
  EXPECT_NEAR((gradient - Vec3f::UnitX()).norm(), 0, 1e-4f);
}

TEST(Shape, FieldFarOutsideIsALowerBoundThatGrows) {
  PartModelPtr part;
  const Shape shape = box_shape(part, {0.06, 0.04, 0.02});
  float last = 0;
  for (const float x : {0.05f, 0.1f, 0.5f, 5.0f}) {
    const float d = shape.field.sample({x, 0.03f, -0.02f});
    const float exact = Vec3f(x - 0.03f, 0.01f, 0.01f).norm();
    EXPECT_LE(d, exact * 1.001f);
    EXPECT_GT(d, 0.7f * exact);
    EXPECT_GT(d, last);
    last = d;
  }
}

TEST(Shape, ManyPointsAtOnceGiveTheBitsOfOneAfterTheOther) {
  PartModelPtr part;
  const Shape shape = box_shape(part, {0.06, 0.04, 0.02});
  Field ball;
  ball.ball = 0.01f;
  Random random(5, 0, Stream::probe);
  const Carry carry{random.orientation().cast<float>().toRotationMatrix(), Vec3f(0.011f, -0.007f, 0.002f)};
  for (const Field& field : {shape.field, ball}) {
    Points<16> points, carried;
    for (int i = 0; i < 16; ++i)  // inside, near and far outside the grid
      points.set(i, Vec3f(random.uniform(-0.1, 0.1), random.uniform(-0.05, 0.05), random.uniform(-0.03, 0.03)));
    float distance[16];
    sample(field, carry, points, carried, distance);
    for (int i = 0; i < 16; ++i) {
      EXPECT_LE((carried[i] - carry(points[i])).norm(), 1e-8f);
      EXPECT_EQ(distance[i], field.sample(carried[i])) << i;
    }
  }
}

TEST(Shape, EveryCornerAndEdgeOfABoxIsSampled) {
  PartModelPtr part;
  const Vec3 size(0.06, 0.04, 0.02);
  const Shape shape = box_shape(part, size);
  for (const Samples* s : {&shape.coarse, &shape.fine}) {
    int corners = 0;
    for (const Vec3f& n : s->nodes) {
      const Vec3f q = n.cwiseAbs().cwiseQuotient(0.5f * size.cast<float>());
      EXPECT_NEAR(q.maxCoeff(), 1.0f, 1e-4f);  // on the surface
      corners += (q - Vec3f::Ones()).norm() < 1e-4f;
    }
    EXPECT_EQ(corners, 8);
    float length = 0;
    for (const Edge& e : s->edges) length += (s->nodes[e.a] - s->nodes[e.b]).norm();
    EXPECT_NEAR(length, 4 * 0.12f, 1e-5f);  // all twelve edges, once, the diagonals of the faces not
  }
}

TEST(Shape, ClustersHoldTheirNodesAndEdges) {
  PartModelPtr part;
  const Shape shape = box_shape(part, {0.06, 0.04, 0.02});
  const Samples& s = shape.fine;
  for (std::size_t i = 0; i < s.nodes.size(); ++i) {
    const Ball& c = s.clusters[i / cluster_size];
    EXPECT_LE((s.nodes[i] - c.center).norm(), c.radius * 1.0001f);
  }
  for (std::size_t c = 0; c < s.clusters.size(); ++c)
    for (std::uint32_t e = s.first_edge[c]; e < s.first_edge[c + 1]; ++e) {
      EXPECT_EQ(s.edges[e].a / cluster_size, c);
      EXPECT_LE((s.nodes[s.edges[e].b] - s.clusters[c].center).norm(), s.clusters[c].radius * 1.0001f);
    }
}

TEST(Shape, EveryEdgeIsListedOnceWithItsFirstNode) {
  PartModelPtr part;
  const Shape shape = box_shape(part, {0.06, 0.04, 0.02});
  const Samples& s = shape.fine;
  ASSERT_EQ(s.edges_from.size(), s.nodes.size() + 1);
  EXPECT_EQ(s.edges_from.front(), 0u);
  EXPECT_EQ(s.edges_from.back(), s.first_edge.back());
  for (std::size_t i = 0; i < s.nodes.size(); ++i) {
    float longest = -std::numeric_limits<float>::infinity();
    for (std::uint32_t e = s.edges_from[i]; e < s.edges_from[i + 1]; ++e) {
      EXPECT_EQ(s.edges[e].a, i);
      longest = std::max(longest, s.edges[e].length);
    }
    EXPECT_EQ(s.longest_edges[i / cluster_size][i % cluster_size], longest);
    EXPECT_LE(s.nodes[i].norm(), s.extent);
  }
  for (std::size_t c = 0; c < s.clusters.size(); ++c)
    EXPECT_EQ(s.cluster_radii[c / clusters_at_once][c % clusters_at_once], s.clusters[c].radius);
}

TEST(BroadPhase, FindsEveryPairWhoseSurfacesAreNear) {
  PartModelPtr part;
  const Shape shape = box_shape(part, {0.06, 0.04, 0.02}, 0.02);
  World world = world_of_boxes(shape, 60);
  Random random(3, 0, Stream::probe);
  for (Body& b : world.bodies) {
    b.q = random.orientation().cast<float>();
    b.x = Vec3f(random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1));
  }
  find_pairs(world);
  std::set<std::pair<std::uint32_t, std::uint32_t>> found;
  for (const Manifold& m : world.manifolds) {
    EXPECT_LT(m.a, m.b);
    EXPECT_TRUE(found.emplace(m.a, m.b).second) << "a pair twice";
  }
  std::size_t near = 0;
  for (std::uint32_t i = 0; i < world.bodies.size(); ++i)
    for (std::uint32_t j = i + 1; j < world.bodies.size(); ++j) {
      const Body &a = world.bodies[i], &b = world.bodies[j];
      float distance = 1;  // twin: every node of one in the field of the other
      for (const Vec3f& n : shape.fine.nodes) {
        distance = std::min(distance, shape.field.sample(b.q.conjugate() * (a.x + a.q * n - b.x)));
        distance = std::min(distance, shape.field.sample(a.q.conjugate() * (b.x + b.q * n - a.x)));
      }
      if (distance > 0) continue;
      ++near;
      EXPECT_TRUE(found.count({i, j})) << i << " and " << j << " overlap by " << -distance;
    }
  EXPECT_GT(near, 20u);
  EXPECT_LT(found.size(), 60u * 59u / 4u);
}

TEST(BroadPhase, APairIsFoundWhateverElseIsThere) {
  PartModelPtr part, bar;
  const Shape shape = box_shape(part, {0.06, 0.04, 0.02}, 0.02), rail = box_shape(bar, {0.02, 3.0, 0.02}, 0.1);
  World world = world_of_boxes(shape, 600);  // enough for strips
  world.shapes.push_back(&rail);
  Random random(4, 0, Stream::probe);
  for (Body& b : world.bodies) {  // many boxes wide, and on both sides of zero
    b.q = random.orientation().cast<float>();
    b.x = Vec3f(random.uniform(-0.15, 0.15), random.uniform(-3.0, 3.0), random.uniform(-0.03, 0.03));
  }
  world.bodies[7].shape = 1;  // through half of the others
  world.bodies[7].q = Quatf::Identity();
  const std::vector<Body> bodies = world.bodies;
  find_pairs(world);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> found, alone;
  for (const Manifold& m : world.manifolds) found.emplace_back(m.a, m.b);
  World two = world;
  for (std::uint32_t i = 0; i < bodies.size(); ++i)
    for (std::uint32_t j = i + 1; j < bodies.size(); ++j) {
      two.manifolds.clear();
      two.bodies.assign({bodies[i], bodies[j]});
      find_pairs(two);
      if (!two.manifolds.empty()) alone.emplace_back(i, j);
    }
  EXPECT_EQ(found, alone);
  EXPECT_GT(found.size(), 100u);
}

TEST(Color, NoTwoManifoldsOfAColorShareAMovingBody) {
  PartModelPtr part;
  const Shape shape = box_shape(part, {0.06, 0.04, 0.02}, 0.02);
  World world = world_of_boxes(shape, 80);
  Random random(5, 0, Stream::probe);
  for (Body& b : world.bodies) {
    b.q = random.orientation().cast<float>();
    b.x = Vec3f(random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1));
  }
  world.bodies[7].inverse_mass = 0;
  find_pairs(world);
  find_contacts(world);
  color_manifolds(world);
  std::set<std::pair<int, std::uint32_t>> seen;
  int color = 0;
  for (const std::uint32_t i : world.order) {
    const Manifold& m = world.manifolds[i];
    EXPECT_GE(m.color, color);
    color = m.color;
    for (const std::uint32_t b : {m.a, m.b})
      if (b != ground && world.bodies[b].moves()) {
        EXPECT_TRUE(seen.emplace(color, b).second);
      }
  }
  std::size_t to_solve = 0;
  for (const Manifold& m : world.manifolds) to_solve += !m.contacts.empty();
  EXPECT_EQ(world.order.size(), to_solve);
}

TEST(Sleep, AnIslandSleepsAsOneAndATouchWakesIt) {
  PartModelPtr part;
  const Shape shape = box_shape(part, {0.05, 0.05, 0.05});
  World world = world_of_boxes(shape, 3);
  world.planes = {{Vec3f::UnitZ(), 0, false}};
  world.bodies[0].x = Vec3f(0, 0, 0.025f);
  world.bodies[1].x = Vec3f(0, 0, 0.075f);
  world.bodies[2].present = false;
  const auto run = [&](float seconds) {
    for (int k = 0; k < std::lround(seconds / world.settings.time_step); ++k) step(world);
  };
  run(1.0f);
  EXPECT_TRUE(world.bodies[0].asleep);
  EXPECT_TRUE(world.bodies[1].asleep);
  const std::uint64_t tested = world.counters.clusters_tested;
  run(0.5f);
  EXPECT_EQ(world.counters.clusters_tested, tested);  // sleep costs no contact work
  world.bodies[2].present = true;
  world.bodies[2].x = Vec3f(0.01f, 0, 0.16f);
  run(0.15f);
  EXPECT_FALSE(world.bodies[0].asleep);
  EXPECT_FALSE(world.bodies[1].asleep);
}

// A heap that is probed need not wait for one part that creeps: it keeps awake whom it touches, and nobody else.
TEST(Sleep, InAProbeWhoCreepsKeepsOnlyItsNeighboursAwake) {
  PartModelPtr part;
  const Shape shape = box_shape(part, {0.05, 0.05, 0.05});
  for (const Sleep sleep : {Sleep::by_island, Sleep::by_part}) {
    World world = world_of_boxes(shape, 3);
    world.sleep = sleep;
    world.planes = {{Vec3f::UnitZ(), 0, false}};
    for (int i = 0; i < 3; ++i) world.bodies[i].x = Vec3f(0, 0, 0.025f + 0.05f * i);
    const auto all_sleep = [&] {
      return std::all_of(world.bodies.begin(), world.bodies.end(), [](const Body& b) { return b.asleep; });
    };
    for (int k = 0; k < 400 && !all_sleep(); ++k) step(world);
    ASSERT_TRUE(all_sleep());
    world.bodies[2].asleep = false;
    world.bodies[2].still = 0;
    update_sleep(world);
    EXPECT_FALSE(world.bodies[2].asleep);
    EXPECT_FALSE(world.bodies[1].asleep);
    EXPECT_EQ(world.bodies[0].asleep, sleep == Sleep::by_part);
    for (int k = 0; k < 400 && !all_sleep(); ++k) step(world);
    EXPECT_TRUE(all_sleep());
  }
}

// What is taken out of a heap at rest wakes what touched it. That wakes others only if it goes.
TEST(Sleep, ByTouchWhatGoesWakesWhatItTouches) {
  PartModelPtr part;
  const Shape shape = box_shape(part, {0.05, 0.05, 0.05});
  World world = world_of_boxes(shape, 5);
  world.planes = {{Vec3f::UnitZ(), 0, false}};
  for (int i = 0; i < 5; ++i) world.bodies[i].x = Vec3f(0, 0, 0.025f + 0.05f * i);
  world.bodies[4].x = Vec3f(0.5f, 0, 0.025f);  // alone
  for (int k = 0; k < 20; ++k) step(world);
  world.sleep = Sleep::by_touch;
  for (Body& b : world.bodies) put_to_sleep(world.settings, b);
  const auto awake = [&] {
    std::vector<int> ids;
    for (int i = 0; i < 5; ++i)
      if (world.bodies[i].moves()) ids.push_back(i);
    return ids;
  };
  EXPECT_EQ(awake(), std::vector<int>());
  EXPECT_EQ(touched_by(world, 1), (std::vector<std::uint32_t>{0, 2}));
  const auto take_out = [&](std::uint32_t body) {
    for (const std::uint32_t other : touched_by(world, body)) wake(world.bodies[other]);
    world.bodies[body].present = false;
  };
  const Vec3f top = world.bodies[3].x;
  take_out(1);
  EXPECT_EQ(awake(), (std::vector<int>{0, 2}));
  for (int k = 0; k < 2; ++k) step(world);
  EXPECT_EQ(awake(), (std::vector<int>{0, 2, 3})) << "what it carried";
  for (int k = 0; k < 200; ++k) step(world);
  EXPECT_EQ(awake(), std::vector<int>());
  EXPECT_NEAR(top.z() - world.bodies[3].x.z(), 0.05f, 1e-4f);
  const Vec3f below = world.bodies[0].x;
  take_out(3);
  step(world);
  EXPECT_EQ(awake(), std::vector<int>{2}) << "it stays, and wakes nobody";
  EXPECT_EQ(world.bodies[0].x, below);
}

/// A pass that the compiler makes in several versions for several machines can be left by an exception in each of them.
TEST(Passes, ACancelledPassThrowsToItsCaller) {
  PartModelPtr part;
  const Shape shape = box_shape(part, {0.06, 0.04, 0.02});
  const std::atomic<bool> unwanted{true};
  for (void (*pass)(World&) : {find_pairs, find_contacts, solve}) {
    World world = world_of_boxes(shape, 20);  // all in one place
    find_pairs(world);
    if (pass == solve) color_manifolds(world);
    const CancelScope scope(&unwanted);
    EXPECT_THROW(pass(world), Error);
  }
}

}  // namespace
}  // namespace bin_scenes::sphere
