/// Blocks: what they must hold, and that a solve in blocks is the solve of the whole.
#include "solver/sphere/passes/blocks.hpp"
#include "bin_scenes/core/random.hpp"
#include "boxes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace bin_scenes::sphere {
namespace {

/// Some bodies sleep, some are fixed; manifolds join others near them in the list, of which a tenth has no contact.
World world_of_random_manifolds(const Shape& shape, std::size_t count) {
  World world = world_of_boxes(shape, count);
  Random random(11, 0, Stream::probe);
  for (Body& b : world.bodies) {
    b.asleep = random.uniform(0, 1) < 0.2;
    if (random.uniform(0, 1) < 0.1) b.inverse_mass = 0;
  }
  for (std::uint32_t a = 0; a < count; ++a)
    for (const std::uint32_t step : {1u, 5u, 90u}) {
      if (a + step >= count || random.uniform(0, 1) < 0.6) continue;
      Manifold m;
      m.a = a;
      m.b = step == 90 && random.uniform(0, 1) < 0.9 ? ground : a + step;
      m.contacts.resize(random.uniform(0, 1) < 0.1 ? 0 : 1);
      world.manifolds.push_back(m);
    }
  color_manifolds(world);
  return world;
}

TEST(Blocks, EachMovingBodyAndManifoldIsInOneAndNoManifoldJoinsTwo) {
  PartModelPtr part;
  const Shape shape = box_shape(part, Vec3::Constant(0.02), 0.02);
  const World world = world_of_random_manifolds(shape, 1000);
  Blocks blocks;
  for (const std::size_t usual : {1u, 16u, 5000u}) {
    blocks.make(world, usual);
    std::multiset<std::uint32_t> bodies, manifolds;
    for (std::size_t block = 0; block < blocks.count(); ++block) {
      const Slice own = blocks.bodies(block);
      EXPECT_TRUE(std::is_sorted(own.begin(), own.end()));
      EXPECT_TRUE(own.size() >= usual || block + 1 == blocks.count());
      for (std::size_t k = 0; k < own.size(); ++k) EXPECT_EQ(blocks.place(block, own[k]), k);
      bodies.insert(own.begin(), own.end());
      int color = 0;
      for (const std::uint32_t i : blocks.manifolds(block)) {
        const Manifold& m = world.manifolds[i];
        EXPECT_GE(m.color, color);
        color = m.color;
        for (const std::uint32_t b : {m.a, m.b}) {
          const bool moves = b != ground && world.bodies[b].moves();
          EXPECT_EQ(std::binary_search(own.begin(), own.end(), b), moves);
          if (!moves) {
            EXPECT_EQ(blocks.place(block, b), own.size());
          }
        }
        manifolds.insert(i);
      }
    }
    std::multiset<std::uint32_t> moving;
    for (std::uint32_t i = 0; i < world.bodies.size(); ++i)
      if (world.bodies[i].moves()) moving.insert(i);
    EXPECT_EQ(bodies, moving);
    EXPECT_EQ(manifolds, std::multiset<std::uint32_t>(world.order.begin(), world.order.end()));
    EXPECT_EQ(blocks.count() == 1, usual == 5000);
  }
}

TEST(Blocks, AStackHasTheSameBitsAloneAndAmongManyBlocks) {
  PartModelPtr part;
  const Shape shape = box_shape(part, {0.06, 0.06, 0.02});
  const auto stack_after = [&](std::size_t others) {
    World world = world_of_boxes(shape, 4 + others);
    world.settings.sharing_sweeps = 0;  // which a large world does without
    world.planes = {{Vec3f::UnitZ(), 0, false}};
    for (std::size_t i = 0; i < world.bodies.size(); ++i) {
      const auto pile = static_cast<float>(i / 4), place = static_cast<float>(i % 4);
      world.bodies[i].x = Vec3f(pile + 0.013f * place, 0.0f, 0.011f + 0.021f * place);
      world.bodies[i].w = Vec3f(1.0f, -2.0f, 0.5f * place);
    }
    for (int k = 0; k < 60; ++k) step(world);
    world.bodies.resize(4);
    return world.bodies;
  };
  const std::vector<Body> alone = stack_after(0), among = stack_after(3 * Blocks::usual_bodies);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(alone[i].x, among[i].x);
    EXPECT_EQ(alone[i].q.coeffs(), among[i].q.coeffs());
    EXPECT_EQ(alone[i].v, among[i].v);
    EXPECT_GT((alone[i].x - Vec3f(0.013f * static_cast<float>(i), 0, 0.011f + 0.021f * static_cast<float>(i))).norm(),
              1e-4f);  // something happened
  }
}

}  // namespace
}  // namespace bin_scenes::sphere
