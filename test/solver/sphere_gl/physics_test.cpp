#include "solver/closed_forms.hpp"
#include "solver/extremes.hpp"
#include "solver/free_turns.hpp"
#include "solver/hard_contact_scenes.hpp"
#include "solver/sphere/world.hpp"
#include "solver/sphere_gl/gl_sphere_solver.hpp"
#include "solver/worst_contacts.hpp"

namespace bin_scenes::testing {

const SolverCase sphere_gl{"sphere_gl", [] { return make_gl_sphere_solver({}); }, 1e-4};
const SolverCase sphere_gl_coarse{"sphere_gl", [] {
                                    SphereSettings settings;
                                    settings.time_step = 1.0 / 15.0;
                                    return make_gl_sphere_solver(settings);
                                  }};
const SolverCase sphere_gl_uncut{"sphere_gl", [] {
                                   SphereSettings settings;
                                   settings.time_step = 1.0 / 15.0;
                                   settings.cut_steps = false;
                                   return make_gl_sphere_solver(settings);
                                 }};

const auto name = [](const auto& info) { return info.param.name; };

TEST(SphereGlBall, KeepsItsEnergyWhereNothingIsLostInABounce) {
  EXPECT_LT(elastic_change(Lab(sphere_gl.make())), 5e-4);
}

TEST(SphereGlBall, OnAPlateRollsAsFastAsThePlateTakesIt) {
  EXPECT_LT(ride(Lab(sphere_gl.make())), 3e-3);
}

TEST(SphereGlSpin, IsLostToThePatchOfAContact) {
  EXPECT_NEAR(spin_lost(Lab(sphere_gl.make()), sphere::Settings{}.patch_radius), 1.0, 0.02);
}

TEST(SphereGlSwing, AboutARidgeIsLostToThePatchOfTheContact) {
  EXPECT_NEAR(swing_lost(Lab(sphere_gl.make()), sphere::Settings{}.patch_radius), 1.0, 0.05);
}

TEST(SphereGlRim, AFlatBarThatLeansOnItComesToRest) {
  for (const double lean : {1.0, 1.2})
    EXPECT_LT(time_to_rest_on_the_rim(Lab(sphere_gl.make()), {0.1, 0.04, 0.05, 0.2, lean}), 5.0) << lean;
}

// The same as in sphere_test, for three impacts that overlapped by 1.0 to 2.2 %.
TEST(SphereGlImpacts, ABarIsStoppedWhereAWallAndTheFloorOfAChannelEnd) {
  const PartModelPtr part = channel(0.05);
  for (const std::uint64_t seed : {462, 683, 491}) {
    const double depth = overlap_beside_a_saddle(Lab(sphere_gl.make()), part, 0.05, seed);
    EXPECT_GE(depth, 0.0) << "starts apart";
    EXPECT_LT(depth, 0.005) << seed;
  }
}

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(Stacks);  // minutes on a software device
INSTANTIATE_TEST_SUITE_P(SphereGl, ClosedForms, ::testing::Values(sphere_gl), name);
INSTANTIATE_TEST_SUITE_P(SphereGl, FreeTurns, ::testing::Values(sphere_gl), name);
INSTANTIATE_TEST_SUITE_P(SphereGl, Counted, ::testing::Values(sphere_gl), name);
INSTANTIATE_TEST_SUITE_P(SphereGl, Extremes, ::testing::Values(sphere_gl), name);
INSTANTIATE_TEST_SUITE_P(SphereGl, WorstContacts, ::testing::Values(sphere_gl), name);
INSTANTIATE_TEST_SUITE_P(SphereGl, CoarseSteps, ::testing::Values(sphere_gl_coarse), name);
INSTANTIATE_TEST_SUITE_P(SphereGl, UncutSteps, ::testing::Values(sphere_gl_uncut), name);

}  // namespace bin_scenes::testing
