#include "solver/closed_forms.hpp"
#include "solver/extremes.hpp"
#include "solver/sphere/sphere_solver.hpp"

namespace bin_scenes::testing {

const SolverCase sphere_default{"sphere", [] { return make_sphere_solver({}); }, 1e-4};
const SolverCase sphere_coarse{"sphere", [] {
                                 SphereSettings settings;
                                 settings.time_step = 1.0 / 15.0;
                                 return make_sphere_solver(settings);
                               }};

const auto name = [](const auto& info) { return info.param.name; };

INSTANTIATE_TEST_SUITE_P(Sphere, ClosedForms, ::testing::Values(sphere_default), name);
INSTANTIATE_TEST_SUITE_P(Sphere, Extremes, ::testing::Values(sphere_default), name);
INSTANTIATE_TEST_SUITE_P(Sphere, CoarseSteps, ::testing::Values(sphere_coarse), name);

}  // namespace bin_scenes::testing
