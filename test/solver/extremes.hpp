/// Small, thin and fast parts that a solver must hold whatever its time step is. Include in a test file and instantiate
/// as closed_forms.hpp; `SolverCase::make` of long steps comes from CoarseSteps and UncutSteps below.
#pragma once

#include "solver/fixture.hpp"
#include "solver/impact_scenes.hpp"
#include "solver/tight_scenes.hpp"

#include <algorithm>

namespace bin_scenes::testing {

class Extremes : public SolverTest {};

/// The same under time steps of 1/15 s.
class CoarseSteps : public SolverTest {};

/// The same, with nothing cut.
class UncutSteps : public SolverTest {};

TEST_P(UncutSteps, AreAsLongAsAskedForWhateverFlies) {
  Lab lab = this->lab();
  lab.place(box(Vec3::Constant(5e-4)), Vec3(0, 0, 0.1));
  lab.place(box(Vec3::Constant(0.05)), Vec3(0, 0, 1));
  lab.start(1).velocity = {Vec3(30, 0, 10), Vec3(0, 200, 0)};
  lab.simulate(0.4);
  EXPECT_TRUE(lab.solver().flags(lab.world()).empty());
  EXPECT_EQ(lab.solver().steps(lab.world()), 6u);
}

TEST_P(CoarseSteps, PartOfHalfAMillimetreRestsOnTheFloor) {
  const double edge = 5e-4;
  Lab lab = this->lab();
  lab.place(box(Vec3::Constant(edge)), Vec3(0, 0, edge));
  lab.simulate(0.4);
  EXPECT_NEAR(lab.center(0).z(), 0.5 * edge, 0.01 * edge);
  const std::vector<Flag> flags = lab.solver().flags(lab.world());
  EXPECT_TRUE(std::any_of(flags.begin(), flags.end(), [](const Flag& flag) { return flag.code == "time_step_cut"; }));
}

TEST_P(Extremes, OrdinaryPartsAndStepsAreNotCut) {
  Lab lab = this->lab();
  lab.place(box(Vec3::Constant(0.05)), Vec3(0, 0, 0.05));
  lab.simulate(0.05);
  EXPECT_TRUE(lab.solver().flags(lab.world()).empty());
  EXPECT_EQ(lab.solver().steps(lab.world()), static_cast<std::uint64_t>(std::lround(0.05 / lab.solver().step_size())));
}

/// A screw set down on its head, tilted and going round: it rolls over the corners of the rim, comes to lie, and is
/// never lifted higher than it was.
TEST_P(Extremes, WhatWobblesOnItsRimComesToLie) {
  Lab lab = this->lab();
  const PartModelPtr screw =
      PartModel::from_mesh(merged(prism_mesh(24, 0.0065, 0.0, 0.0053), prism_mesh(24, 0.004, 0.0053, 0.035)), "screw");
  const Vec3 center = screw->mass().center;
  const Quat tilt(Eigen::AngleAxisd(0.09, Vec3::UnitX()));
  lab.place(screw, tilt * center + Vec3(0, 0, 0.0065 * std::sin(0.09)), tilt);
  lab.start(0).velocity = {Vec3(0, 0.02, 0), Vec3(0, 2.5, 0.3)};
  double highest = 0.0;
  for (int k = 0; k < 40; ++k) {
    lab.simulate(0.05);
    const double height = lab.center(0).z();
    if (lab.time() < 0.25) {
      highest = std::max(highest, height);
    } else {
      EXPECT_LT(height, highest) << lab.time() << " s";
    }
  }
  EXPECT_NEAR(lab.center(0).z(), center.z(), 2e-5);
  EXPECT_LT(lab.state(0).velocity.angular.norm(), 0.05);
}

/// Rings of many pieces: a load that runs through hundreds of contacts.
TEST_P(Extremes, RingsOnEachOtherStandStill) {
  Lab lab = this->lab();
  const double height = 0.012;
  const PartModelPtr ring = PartModel::from_mesh(ring_mesh(12, 0.018, 0.03, height), "ring");
  constexpr int rings = 6;
  for (int k = 0; k < rings; ++k)
    lab.place(ring, Vec3(0, 0, (k + 0.5) * height), Quat(Eigen::AngleAxisd(k % 2 * 1e-5, Vec3::UnitZ())));
  lab.simulate(0.5);
  std::vector<Vec3> centers;
  for (int k = 0; k < rings; ++k) centers.push_back(lab.center(k));
  for (int k = 0; k < 20; ++k) {
    lab.simulate(0.01);
    for (int r = 0; r < rings; ++r) EXPECT_LT(lab.state(r).velocity.linear.norm(), 2e-3) << "ring " << r;
  }
  for (int r = 0; r < rings; ++r) EXPECT_LT((lab.center(r) - centers[r]).norm(), 2e-5) << "ring " << r;
}

TEST_P(Extremes, SheetsOfAFifthOfAMillimetreStopEachOther) {
  const Sheets sheets = falling_sheet(lab());
  EXPECT_LT(sheets.lower, 0.25);
  EXPECT_LT(sheets.upper, 0.25);
}

TEST_P(Extremes, HundredMetresASecondStayInTheBin) {
  for (const Vec3& velocity : {Vec3(0, 10, -99.5), Vec3(98, 20, 0), Vec3(58, 58, -58)}) {
    Lab lab = this->lab();
    lab.def().bin.kind = Bin::Kind::box;
    lab.def().bin.inner_size = Vec3(0.4, 0.4, 20.0);
    lab.def().wall_height = 20.0;
    lab.place(PartModel::from_mesh(merged(box_mesh({0.05, 0.01, 0.03}), box_mesh({0.01, 0.05, 0.03}, {-0.02, 0.03, 0})),
                                   "angle"),
              Vec3(0, 0, 0.3));
    lab.start(0).velocity = {velocity, Vec3(5, 7, 3)};
    for (int k = 0; k < 60; ++k) {
      lab.simulate(1.0 / 60.0);
      const Vec3 center = lab.center(0);
      ASSERT_TRUE(center.allFinite());
      ASSERT_LT(center.head<2>().cwiseAbs().maxCoeff(), 0.2) << velocity.transpose();
      ASSERT_GT(center.z(), 0.0) << velocity.transpose();
    }
    EXPECT_LT(lab.kinetic_energy(0), 0.5 * 1e4);
  }
}

TEST_P(Extremes, ThousandRadiansASecondKeepTheirEnergy) {
  Lab lab = this->lab();
  lab.def().bin.kind = Bin::Kind::none;
  lab.def().gravity.setZero();
  lab.place(box(Vec3(0.06, 0.04, 0.006)), Vec3::Zero());
  lab.start(0).velocity.angular = 1000.0 * Vec3(0.01, 1.0, 0.01).normalized();
  lab.simulate(1.0 / 60.0);
  const double energy = lab.kinetic_energy(0, lab.start(0));
  for (int k = 0; k < 30; ++k) {
    lab.simulate(1.0 / 60.0);
    EXPECT_NEAR(lab.kinetic_energy(0) / energy, 1.0, 1e-3);
  }
}

// When what slept was as heavy as a wall until the end of the step, a cube sprang back from its equal at full speed.
// The last sweeps of a step look ahead by a sub-step: they meet what will be hit only in the next step.
TEST_P(Extremes, ASleepingPartTakesItsShareOfAnImpact) {
  for (const double restitution : {0.0, 0.5, 1.0})
    for (int eighth = 0; eighth < 8; ++eighth) {
      const double distance = 0.5 + eighth / 8.0 * 2.5e-3;  // m; the last term is a share of a step
      EXPECT_LT(error_of_impact_on_a_sleeper(lab(), restitution, distance), 1e-3)
          << "restitution " << restitution << ", " << eighth << " eighths of a step later";
    }
}

}  // namespace bin_scenes::testing
