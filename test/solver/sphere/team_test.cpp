/// Team: shared loops are done once and whole, and a wide block has the same bits with any number of threads.
#include "solver/sphere/passes/team.hpp"
#include "boxes.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <stdexcept>
#include <vector>

namespace bin_scenes::sphere {
namespace {

/// As if the machine had so many processors.
template <class Work>
void with_threads(int threads, const Work& work) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  tbb::task_arena(threads).execute(work);
}

TEST(Team, DoesEachPieceOfEachLoopOnceBeforeTheNextBegins) {
  with_threads(4, [] {
    Team team;
    std::vector<std::uint32_t> done(1000, 0);
    team.run(3, [&] {
      for (std::uint32_t loop = 0; loop < 20000; ++loop) {
        const auto count = static_cast<std::uint32_t>(loop % done.size());
        team.share(count, 1 + loop % 7, [&](std::uint32_t first, std::uint32_t last) {
          for (std::uint32_t i = first; i < last; ++i) ++done[i];
        });
        if (loop % done.size() + 1 < done.size()) continue;
        for (std::size_t i = 0; i < done.size(); ++i)
          ASSERT_EQ(done[i], (loop / done.size() + 1) * (done.size() - 1 - i)) << "in loop " << loop;
      }
    });
  });
}

TEST(Team, EndsWithItsLeader) {
  with_threads(4, [] {
    Team team;
    EXPECT_THROW(team.run(3, [] { throw std::runtime_error("cancelled"); }), std::runtime_error);
  });
}

TEST(Team, AWideBlockHasTheSameBitsWithAnyNumberOfThreads) {
  PartModelPtr part;
  const Shape shape = box_shape(part, {0.02, 0.02, 0.02});
  constexpr std::size_t side = 20, layers = 3;
  const auto bodies_with = [&](int threads) {
    World world = world_of_boxes(shape, side * side * layers);
    world.settings.sharing_sweeps = 0;
    world.planes = {{Vec3f::UnitZ(), 0, false}};
    for (std::size_t i = 0; i < world.bodies.size(); ++i) {
      const auto at = [](std::size_t k) { return 0.02f * static_cast<float>(k); };
      const std::size_t layer = i / (side * side);
      world.bodies[i].x =
          Vec3f(at(i % side) + 0.005f * static_cast<float>(layer), at(i / side % side), 0.01f + at(layer));
      world.bodies[i].v = Vec3f(0, 0, i % 7 == 0 ? 0.2f : 0.0f);
    }
    with_threads(threads, [&] {
      for (int k = 0; k < 20; ++k) step(world);
    });
    EXPECT_GT(world.order.size(), 2000u) << "too few manifolds to be shared";
    return world.bodies;
  };
  const std::vector<Body> alone = bodies_with(1);
  for (const int threads : {2, 4}) {
    const std::vector<Body> shared = bodies_with(threads);
    for (std::size_t i = 0; i < alone.size(); ++i) {
      ASSERT_EQ(alone[i].x, shared[i].x) << "body " << i << " with " << threads << " threads";
      ASSERT_EQ(alone[i].q.coeffs(), shared[i].q.coeffs());
      ASSERT_EQ(alone[i].v, shared[i].v);
    }
  }
}

}  // namespace
}  // namespace bin_scenes::sphere
