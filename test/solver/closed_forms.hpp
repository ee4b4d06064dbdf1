/// Closed forms every solver must reproduce with its default settings. Tolerances are those of the project's measures.
/// Include in a test file and instantiate: INSTANTIATE_TEST_SUITE_P(Bullet, ClosedForms, ::testing::Values(...)).
#pragma once

#include "solver/fixture.hpp"

namespace bin_scenes::testing {

class ClosedForms : public SolverTest {};

TEST_P(ClosedForms, FreeFallIsAParabola) {
  Lab lab = this->lab();
  lab.def().bin.kind = Bin::Kind::none;
  const auto body = lab.place(box({0.05, 0.03, 0.02}), Vec3(0.1, 0.2, 0.3));
  lab.start(body).velocity.linear = Vec3(0.5, 0.0, 1.0);
  lab.simulate(1.0);
  const double t = lab.time();
  const Vec3 way = lab.center(body) - Vec3(0.1, 0.2, 0.3), expected(0.5 * t, 0.0, t - 0.5 * 9.81 * t * t);
  EXPECT_NEAR((way - expected).norm() / expected.norm(), 0.0, 1e-4);
  EXPECT_NEAR(lab.state(body).velocity.linear.z(), 1.0 - 9.81 * t, 1e-4 * 9.81 * t);
}

TEST_P(ClosedForms, BounceReachesRestitutionSquaredOfTheHeight) {
  for (const double drop : {0.3, 0.437, 0.6}) {
    Lab lab = this->lab();
    const auto ball = lab.place(sphere(0.025), Vec3(0, 0, 0.025 + drop), Quat::Identity(), material(0.5, 0.9));
    double lowest = drop, peak = 0.0;
    while (lab.time() < 3.0 * std::sqrt(2.0 * drop / 9.81)) {
      lab.simulate(lab.solver().step_size());
      const double height = lab.center(ball).z() - 0.025;
      if (lab.state(ball).velocity.linear.z() < 0.0 && peak > 0.0) break;
      if (lab.state(ball).velocity.linear.z() > 0.0) peak = std::max(peak, height);
      lowest = std::min(lowest, height);
    }
    EXPECT_NEAR(peak / drop, 0.81, 0.0081) << "dropped from " << drop;
  }
}

TEST_P(ClosedForms, SlidingDistanceFollowsFromFriction) {
  Lab lab = this->lab();
  lab.def().bin.friction = 0.45;
  const auto body = lab.place(box({0.05, 0.04, 0.01}), Vec3(0, 0, 0.005), Quat::Identity(), material(0.2));
  lab.start(body).velocity.linear = Vec3(0.8, 0.6, 0.0);
  lab.simulate(1.0);
  const double mu = 0.3;  // sqrt(0.45 * 0.2)
  const Vec3 way = lab.center(body) - Vec3(0, 0, 0.005);
  EXPECT_NEAR(way.head<2>().norm(), 1.0 / (2.0 * mu * 9.81), 0.005 / (2.0 * mu * 9.81));
  EXPECT_NEAR(way.y() / way.x(), 0.75, 0.01);
  EXPECT_LT(lab.state(body).velocity.linear.norm(), 1e-3);
}

/// A tilted gravity stands for a slope; `heading` is the direction down it, which must not matter.
inline double slip(Lab lab, const PartModelPtr& part, double angle, double heading) {
  lab.def().gravity =
      9.81 * Vec3(std::sin(angle) * std::cos(heading), std::sin(angle) * std::sin(heading), -std::cos(angle));
  const double height = part->mesh().bounds().size().z();
  const auto body = lab.place(part, Vec3(0, 0, 0.5 * height), Quat::Identity(), material(0.5));
  lab.simulate(1.0);
  return lab.center(body).head<2>().norm();
}

TEST_P(ClosedForms, SticksBelowTheFrictionAngleAndSlipsAbove) {
  const double threshold = std::atan(0.5), half_degree = 0.5 * M_PI / 180.0;
  for (const double heading : {0.0, 0.4, 0.25 * M_PI}) {
    EXPECT_LT(slip(lab(), box({0.05, 0.05, 0.01}), threshold - half_degree, heading), 1e-3) << heading;
    EXPECT_GT(slip(lab(), box({0.05, 0.05, 0.01}), threshold + half_degree, heading), 0.02) << heading;
  }
}

TEST_P(ClosedForms, SphereRollsDownASlope) {
  Lab lab = this->lab();
  const double angle = 15.0 * M_PI / 180.0;
  lab.def().gravity = 9.81 * Vec3(std::sin(angle), 0.0, -std::cos(angle));
  const PartModelPtr ball = sphere(0.025);
  const auto body = lab.place(ball, Vec3(0, 0, 0.025), Quat::Identity(), material(0.5));
  lab.simulate(1.0);
  // From the tessellated body's own moment of inertia; 5/7 g sin(angle) for an ideal ball.
  const double k = ball->mass().principal.mean() / (ball->mass().volume * 0.025 * 0.025);
  const double expected = 0.5 * 9.81 * std::sin(angle) / (1.0 + k) * lab.time() * lab.time();
  EXPECT_NEAR(lab.center(body).x(), expected, 0.002 * expected);
}

TEST_P(ClosedForms, CollisionKeepsMomentumAndNeverGainsEnergy) {
  for (const double restitution : {0.0, 0.5, 1.0}) {
    Lab lab = this->lab();
    lab.def().bin.kind = Bin::Kind::none;
    lab.def().gravity.setZero();
    const auto a = lab.place(box({0.05, 0.03, 0.02}), Vec3(-0.06, 0.004, 0.002),
                             Quat(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized())), material(0.4, restitution, 0.3));
    const auto b = lab.place(box({0.04, 0.04, 0.04}), Vec3(0.06, 0, 0), Quat::Identity(), material(0.4, 0.0, 0.2));
    lab.start(a).velocity.linear = Vec3(0.8, 0.0, 0.0);
    lab.start(b).velocity.linear = Vec3(-0.5, 0.0, 0.0);
    lab.start(b).velocity.angular = Vec3(0, 3, 5);
    const auto total_energy = [&] { return lab.kinetic_energy(a) + lab.kinetic_energy(b); };
    const auto total_spin = [&] {
      return Vec3(lab.spin(a) + lab.spin(b) + lab.center(a).cross(lab.momentum(a)) +
                  lab.center(b).cross(lab.momentum(b)));
    };
    lab.simulate(lab.solver().step_size());
    const Vec3 momentum = lab.momentum(a) + lab.momentum(b), spin = total_spin();
    const double energy = total_energy(), before = lab.state(a).velocity.linear.x();
    double highest = energy;
    while (lab.time() < 0.3) {
      lab.simulate(lab.solver().step_size());
      highest = std::max(highest, total_energy());
    }
    EXPECT_GT(std::abs(lab.state(a).velocity.linear.x() - before), 0.1) << "they did not meet";
    EXPECT_LT((lab.momentum(a) + lab.momentum(b) - momentum).norm(), 1e-5 * (0.3 * 0.8 + 0.2 * 0.5));
    EXPECT_LT((total_spin() - spin).norm(), 0.02 * (0.24 * 0.05)) << restitution;
    EXPECT_LT(highest, energy * (1.0 + 1e-5)) << restitution;
  }
}

/// Dzhanibekov: a body that turns about its middle axis tumbles, and keeps energy and angular momentum while it does.
TEST_P(ClosedForms, FreeTumblingKeepsEnergyAndAngularMomentum) {
  Lab lab = this->lab();
  lab.def().bin.kind = Bin::Kind::none;
  lab.def().gravity.setZero();
  const auto body = lab.place(box({0.06, 0.03, 0.01}), Vec3::Zero());
  lab.start(body).velocity.angular = Vec3(0.01, 8.0, 0.01);
  lab.simulate(lab.solver().step_size());
  const double energy = lab.kinetic_energy(body);
  const Vec3 spin = lab.spin(body);
  double lowest = energy, highest = energy, turned = 1.0;
  while (lab.time() < 10.0) {
    lab.simulate(0.02);
    lowest = std::min(lowest, lab.kinetic_energy(body));
    highest = std::max(highest, lab.kinetic_energy(body));
    turned = std::min(turned, (lab.state(body).pose.orientation * Vec3::UnitY()).y());
    EXPECT_NEAR(lab.spin(body).norm() / spin.norm(), 1.0, 1e-3);
  }
  EXPECT_LT(turned, -0.9) << "it never turned over";
  EXPECT_LT(highest / energy, 1.0 + GetParam().rounding);
  EXPECT_GT(lowest / energy, 1.0 - 1e-3);
}

/// Faces that meet edge on edge: not yet for solvers whose normals come from a grid, which lean over such edges.
class AlignedFaces : public SolverTest {};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(AlignedFaces);

/// The thesis's figures 3.2 to 3.4: a rod that meets another with many contacts at once exchanges no more than one.
TEST_P(AlignedFaces, ManyContactsAtOnceDoNotMultiplyTheImpulse) {
  Lab lab = this->lab();
  lab.def().bin.kind = Bin::Kind::none;
  lab.def().gravity.setZero();
  const PartModelPtr rod = box({0.06, 0.01, 0.01});
  const auto a = lab.place(rod, Vec3(0, 0, -0.02), Quat::Identity(), material(0.0, 1.0));
  const auto b = lab.place(rod, Vec3(0, 0, 0.02), Quat::Identity(), material(0.0, 1.0));
  lab.start(a).velocity.linear = Vec3(0, 0, 0.4);
  lab.simulate(0.2);
  EXPECT_NEAR(lab.state(a).velocity.linear.z(), 0.0, 0.004);
  EXPECT_NEAR(lab.state(b).velocity.linear.z(), 0.4, 0.004);
}

}  // namespace bin_scenes::testing
