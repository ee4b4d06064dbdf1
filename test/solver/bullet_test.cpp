#include "bin_scenes/solver/bullet_solver.hpp"
#include "solver/closed_forms.hpp"
#include "solver/extremes.hpp"
#include "solver/hard_contacts.hpp"
#include "solver/impacts.hpp"
#include "solver/pressed.hpp"
#include "solver/tight_fits.hpp"
#include "solver/worst_contacts.hpp"

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

// A ball rebounds from the floor while it parts from one above it, which it then strikes in the same step.
TEST(BulletImpacts, ThatFollowEachOtherInAStepGainNoEnergy) {
  BulletSettings settings;
  settings.time_step = 0.0005;
  for (double floor_gap = 1e-4; floor_gap < 0.0035; floor_gap += 1.2e-4) {
    for (const double lean : {0.03, 0.13, 0.43, 0.93}) {
      SCOPED_TRACE("floor_gap " + std::to_string(floor_gap) + ", lean " + std::to_string(lean));
      Lab lab(make_bullet_solver(settings));
      lab.def().bin.friction = 0.0;
      const PartModelPtr ball = sphere(0.1);
      const Vec3 axis(std::sin(lean), 0, std::cos(lean)), across(axis.z(), 0, -axis.x());
      const Vec3 below(0, 0, 0.1 + floor_gap);
      lab.place(ball, below, Quat::Identity(), material(0.0, 1.0, 10.0));
      lab.place(ball, below + 0.1999 * axis, Quat::Identity(), material(0.0, 1.0, 10.0));
      lab.start(0).velocity.linear = Vec3(1, 0, -6.78);
      lab.start(1).velocity.linear = Vec3(1, 0, -6.78) + 1.8 * axis + 3.0 * across;
      const auto energy = [&](const std::vector<BodyState>& states) {
        double sum = 0.0;
        for (std::size_t b = 0; b < states.size(); ++b)
          sum += lab.kinetic_energy(b, states[b]) + 98.1 * states[b].pose.position.z();
        return sum;
      };
      const double before = energy({lab.start(0), lab.start(1)});
      lab.simulate(0.003);
      EXPECT_LT(energy(lab.states()), 1.005 * before);
    }
  }
}

// It gained 0.01 m g d, 0.026 with a quarter of the step: two walls that hold a spike like a wedge shared an impact in
// more sweeps than there were, what was left overlapped, and what pushed it out was not taken back.
TEST(BulletTightFits, ASpikeThatRattlesInAHoleGainsNoEnergy) {
  for (const double share : {1.0, 0.25})
    for (const double turn : {0.0, 0.4})
      for (const double tilt : {0.1, 0.3})
        for (const double drop : {0.1, 0.5}) {
          SCOPED_TRACE("step " + std::to_string(share) + ", turn " + std::to_string(turn) + ", tilt " +
                       std::to_string(tilt) + ", drop " + std::to_string(drop));
          BulletSettings settings;
          settings.time_step *= share;
          EXPECT_LT(spike_into_hole(Lab(make_bullet_solver(settings)), turn, tilt, 0.0, drop, 0.0), 1.5e-3);
        }
}

TEST(BulletTightFits, AChainHangs) {
  for (const double slack : {0.7, 0.8, 0.9}) {
    const Chain chain = hang_chain(Lab(make_bullet_solver({})), 15, slack);
    EXPECT_LT(chain.risen, 2e-3) << slack;
    EXPECT_LT(chain.apart, 1.0) << slack;
  }
}

INSTANTIATE_TEST_SUITE_P(Bullet, ClosedForms, ::testing::Values(bullet_default), name);
INSTANTIATE_TEST_SUITE_P(Bullet, Counted, ::testing::Values(bullet_default), name);
INSTANTIATE_TEST_SUITE_P(BulletOnMeshes, ClosedForms, ::testing::ValuesIn(on_meshes(bullet_default)), name);
INSTANTIATE_TEST_SUITE_P(Bullet, Impacts, ::testing::Values(bullet_default), name);
INSTANTIATE_TEST_SUITE_P(Bullet, Stacks, ::testing::Values(bullet_default), name);
INSTANTIATE_TEST_SUITE_P(Bullet, Extremes, ::testing::Values(bullet_default), name);
INSTANTIATE_TEST_SUITE_P(Bullet, HardContacts, ::testing::Values(bullet_default), name);
INSTANTIATE_TEST_SUITE_P(Bullet, TightFits, ::testing::Values(bullet_default), name);
INSTANTIATE_TEST_SUITE_P(Bullet, Pressing, ::testing::Values(bullet_default), name);
INSTANTIATE_TEST_SUITE_P(Bullet, WorstContacts, ::testing::Values(bullet_default), name);
INSTANTIATE_TEST_SUITE_P(Bullet, CoarseSteps, ::testing::Values(bullet_coarse), name);
INSTANTIATE_TEST_SUITE_P(Bullet, UncutSteps, ::testing::Values(bullet_uncut), name);

}  // namespace bin_scenes::testing
