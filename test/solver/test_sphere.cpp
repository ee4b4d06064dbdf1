#include "solver/closed_forms.hpp"
#include "solver/sphere/sphere_solver.hpp"

namespace bin_scenes::testing {

const SolverCase sphere_default{"sphere", [] { return make_sphere_solver({}); }, 1e-4};

INSTANTIATE_TEST_SUITE_P(Sphere, ClosedForms, ::testing::Values(sphere_default),
                         [](const auto& info) { return info.param.name; });

}  // namespace bin_scenes::testing
