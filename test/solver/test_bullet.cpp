#include "bin_scenes/solver/bullet_solver.hpp"
#include "solver/closed_forms.hpp"

namespace bin_scenes::testing {

const SolverCase bullet_default{"bullet", [] { return make_bullet_solver({}); }};

INSTANTIATE_TEST_SUITE_P(Bullet, ClosedForms, ::testing::Values(bullet_default),
                         [](const auto& info) { return info.param.name; });

}  // namespace bin_scenes::testing
