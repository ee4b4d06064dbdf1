/// Solver::take_worst_contact() where the depth is known: instantiate as closed_forms.hpp.
#pragma once

#include "solver/fixture.hpp"

namespace bin_scenes::testing {

class WorstContacts : public SolverTest {
 protected:
  static WorstContact taken(Lab& lab) {
    const auto worst = lab.solver().take_worst_contact(lab.world());
    EXPECT_TRUE(worst.has_value());
    return worst.value_or(WorstContact());
  }
};

constexpr double three_sizes[] = {0.005, 0.05, 0.3};  ///< m

TEST_P(WorstContacts, AnOverlapAtTheStartIsReportedOnceWithPartAndTime) {
  for (const double edge : three_sizes) {
    SCOPED_TRACE(edge);
    Lab lab(GetParam().make());
    lab.place(box(Vec3::Constant(edge)), Vec3(0, 0, 0.4 * edge), Quat::Identity(), material(0.5));
    lab.simulate(0.1);
    const WorstContact first = taken(lab);
    EXPECT_EQ(first.a, 0);
    EXPECT_EQ(first.b, -1);
    EXPECT_GE(first.depth, 0.1 * edge - 1e-3 * edge);
    const double fall = 9.81 * lab.solver().step_size() * lab.solver().step_size();
    EXPECT_LE(first.depth, 0.1 * edge + fall + 1e-3 * edge) << "the box may fall for one step before contacts act";
    EXPECT_NEAR(first.relative, first.depth / (edge * std::sqrt(3.0)), 1e-6);
    EXPECT_NEAR(first.ago, 0.1, 0.01) << "in one of the first steps";
    EXPECT_EQ(taken(lab).a, -1) << "it was taken, and nothing was simulated since";
    lab.simulate(0.5);
    taken(lab);
    lab.simulate(0.1);
    EXPECT_LT(taken(lab).relative, 5e-3) << "it has come out";
  }
}

TEST_P(WorstContacts, OfAPairTheSmallerPartIsTheUnit) {
  for (const double edge : three_sizes) {
    SCOPED_TRACE(edge);
    Lab lab(GetParam().make());
    lab.place(box(Vec3::Constant(2.0 * edge)), Vec3(0, 0, edge), Quat::Identity(), material(0.5, 0.0, 8.0));
    lab.place(box(Vec3::Constant(edge)), Vec3(0, 0, 2.44 * edge), Quat::Identity(), material(0.5));
    lab.simulate(0.1);
    const WorstContact worst = taken(lab);
    EXPECT_EQ(worst.a, 0);
    EXPECT_EQ(worst.b, 1);
    EXPECT_NEAR(worst.depth, 0.06 * edge, 2e-3 * edge);
    EXPECT_NEAR(worst.relative, worst.depth / (edge * std::sqrt(3.0)), 1e-6);
  }
}

TEST_P(WorstContacts, WhatFallsAndRestsOverlapsLittle) {
  for (const double edge : three_sizes) {
    SCOPED_TRACE(edge);
    Lab lab(GetParam().make());
    const PartModelPtr cube = box(Vec3::Constant(edge));
    for (const double z : {1.0, 2.5}) lab.place(cube, Vec3(0, 0, z * edge), Quat::Identity(), material(0.5));
    lab.simulate(1.0);
    EXPECT_LT(taken(lab).relative, 0.01);
  }
}

}  // namespace bin_scenes::testing
