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
const SolverCase bullet_uncut{"bullet", [] {
                                BulletSettings settings;
                                settings.time_step = 1.0 / 15.0;
                                settings.cut_steps = false;
                                return make_bullet_solver(settings);
                              }};

const auto name = [](const auto& info) { return info.param.name; };

INSTANTIATE_TEST_SUITE_P(Bullet, ClosedForms, ::testing::Values(bullet_default), name);
INSTANTIATE_TEST_SUITE_P(Bullet, Stacks, ::testing::Values(bullet_default), name);
INSTANTIATE_TEST_SUITE_P(Bullet, Extremes, ::testing::Values(bullet_default), name);
INSTANTIATE_TEST_SUITE_P(Bullet, CoarseSteps, ::testing::Values(bullet_coarse), name);
INSTANTIATE_TEST_SUITE_P(Bullet, UncutSteps, ::testing::Values(bullet_uncut), name);

}  // namespace bin_scenes::testing
