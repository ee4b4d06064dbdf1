#include "bin_scenes/solver/bullet_solver.hpp"
#include "solver/closed_forms.hpp"
#include "solver/extremes.hpp"

namespace bin_scenes::testing {

const SolverCase bullet_default{"bullet", [] { return make_bullet_solver({}); }};
const SolverCase bullet_coarse{"bullet", [] {
                                 BulletSettings settings;
                                 settings.time_step = 1.0 / 15.0;
                                 return make_bullet_solver(settings);
                               }};

const auto name = [](const auto& info) { return info.param.name; };

// Faces of turned boxes coincide only to rounding: patches then have more corners than a manifold has room for.
TEST(BulletStack, TenBoxesDriftLessThanAThousandthInThirtySeconds) {
  for (const double heading : {0.0, 0.3, 0.7})
    EXPECT_LT(stack_drift(Lab(make_bullet_solver({})), 30.0, heading), 1e-3) << heading;
}

TEST(BulletCounters, TellFreeFallFromContactAndSleep) {
  Lab lab(make_bullet_solver({}));
  lab.place(box(Vec3::Constant(0.04)), Vec3(0, 0, 0.07));
  const auto count = [&](const char* name) { return lab.solver().profile().counters.at(name); };
  lab.simulate(0.05);  // it falls by 12 mm of 50 mm
  EXPECT_EQ(count("body_steps_in_free_fall"), count("steps"));
  EXPECT_EQ(count("contacts"), 0u);
  lab.simulate(1.95);
  EXPECT_GT(count("contacts"), 0u);
  EXPECT_GT(count("pairs"), 0u);
  EXPECT_GT(count("body_steps_asleep"), 0u);
  EXPECT_LT(count("body_steps_in_free_fall") + count("body_steps_asleep"), count("steps"));
}

INSTANTIATE_TEST_SUITE_P(Bullet, ClosedForms, ::testing::Values(bullet_default), name);
INSTANTIATE_TEST_SUITE_P(Bullet, Extremes, ::testing::Values(bullet_default), name);
INSTANTIATE_TEST_SUITE_P(Bullet, CoarseSteps, ::testing::Values(bullet_coarse), name);

}  // namespace bin_scenes::testing
