#include "solver/closed_forms.hpp"
#include "solver/extremes.hpp"
#include "solver/sphere_gl/gl_sphere_solver.hpp"

namespace bin_scenes::testing {

const SolverCase sphere_gl{"sphere_gl", [] { return make_gl_sphere_solver({}); }, 1e-4};

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(Stacks);  // minutes on a software device
INSTANTIATE_TEST_SUITE_P(SphereGl, ClosedForms, ::testing::Values(sphere_gl),
                         [](const auto& info) { return info.param.name; });

INSTANTIATE_TEST_SUITE_P(SphereGl, Extremes, ::testing::Values(sphere_gl),
                         [](const auto& info) { return info.param.name; });

}  // namespace bin_scenes::testing
