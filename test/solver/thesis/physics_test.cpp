// Closed forms first, then invariants. Tolerances say where they come from.
#include "scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace bin_scenes::thesis::test {
namespace {

constexpr double g = 9.81;

Vec3 momentum(const std::vector<BodyState>& states, const std::vector<double>& masses) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t b = 0; b < states.size(); ++b) sum += masses[b] * states[b].velocity.linear;
  return sum;
}

Mat3 inertia(const BodyState& state, const Shape& shape, double mass) {
  const Mat3 r = (state.pose.orientation * shape.frame.orientation).toRotationMatrix();
  return mass * r * shape.gyration.asDiagonal() * r.transpose();
}

Vec3 spin_momentum(const BodyState& state, const Shape& shape, double mass) {
  return inertia(state, shape, mass) * state.velocity.angular;
}

double kinetic(const BodyState& state, const Shape& shape, double mass) {
  return 0.5 * mass * state.velocity.linear.squaredNorm() +
         0.5 * state.velocity.angular.dot(spin_momentum(state, shape, mass));
}

TEST(ThesisPhysics, FreeFall) {
  ThesisSolver solver;
  WorldBuilder world;
  world.def.bin.kind = Bin::Kind::none;
  world.body(world.shape(ball(0.01)), Vec3(0, 0, 2), Vec3(1, 0, 0));
  const WorldId id = world.add(solver);
  const double t = solver.advance({id}, 0.5);
  EXPECT_DOUBLE_EQ(t, 0.5);
  const BodyState state = solver.states(id)[0];
  EXPECT_NEAR(state.pose.position.z() - 2.0, -0.5 * g * t * t, 1e-4 * 0.5 * g * t * t);
  EXPECT_NEAR(state.velocity.linear.z(), -g * t, 1e-4 * g * t);
  EXPECT_NEAR(state.pose.position.x(), t, 1e-4 * t);
  EXPECT_EQ(solver.profile().counters.at("contacts"), 0u);
}

TEST(ThesisPhysics, AStretchEndsWithAShorterStep) {
  ThesisSolver solver;
  WorldBuilder world;
  world.def.bin.kind = Bin::Kind::none;
  world.body(world.shape(ball(0.01)), Vec3(0, 0, 2), Vec3(1, 0, 0));
  const WorldId id = world.add(solver);
  EXPECT_NEAR(solver.advance({id}, 0.0011), 0.0011, 1e-12);
  EXPECT_NEAR(solver.advance({id}, 0.0333), 0.0333, 1e-12);
  EXPECT_NEAR(solver.states(id)[0].pose.position.x(), 0.0344, 1e-6);
  EXPECT_NEAR(solver.states(id)[0].velocity.linear.z(), -g * 0.0344, 1e-5);
  EXPECT_EQ(solver.steps(id), 1u + 4u);
}

// Figures 3.2 to 3.4: two rods meet along their whole length. Without mass splitting every contact gives the whole
// impulse. Equal masses, elastic: they exchange velocities.
TEST(ThesisPhysics, RodsThatMeetAtManyPointsExchangeVelocities) {
  ThesisSettings settings;
  settings.iterations = 40;  // what the default 10 leave over is 1e-3 of the speed
  for (int spheres : {1, 2, 5}) {
    ThesisSolver solver(settings);
    WorldBuilder world;
    world.nothing();
    const std::size_t shape = world.shape(rod(spheres, 0.01));
    world.body(shape, Vec3::Zero(), Vec3(0, 1, 0), 0.2, 0.0, 1.0);
    world.body(shape, Vec3(0, 0.0205, 0), Vec3::Zero(), 0.2, 0.0, 1.0);
    const WorldId id = world.add(solver);
    solver.advance({id}, 0.05);
    const std::vector<BodyState> after = solver.states(id);
    EXPECT_NEAR(after[0].velocity.linear.y(), 0.0, 1e-5) << spheres << " spheres";
    EXPECT_NEAR(after[1].velocity.linear.y(), 1.0, 1e-5) << spheres << " spheres";
    EXPECT_LT(after[1].velocity.angular.norm(), 1e-3);
  }
}

TEST(ThesisPhysics, CollisionsKeepMomentumAndNeverGainEnergy) {
  // Off centre, with friction, unequal masses, three bodies at once; slop takes the bias away.
  ThesisSettings settings;
  settings.bias = 0.0;
  ThesisSolver solver(settings);
  WorldBuilder world;
  world.nothing();
  const std::size_t shape = world.shape(rod(4, 0.01));
  const std::vector<double> masses = {0.2, 0.5, 0.3};
  world.body(shape, Vec3::Zero(), Vec3(0.1, 0.8, 0.05), masses[0], 0.4, 0.6);
  world.body(shape, Vec3(0.03, 0.022, 0.004), Vec3(0, -0.3, 0), masses[1], 0.4, 0.6);
  world.body(shape, Vec3(-0.02, 0.046, -0.002), Vec3(0, -0.9, 0), masses[2], 0.4, 0.6);
  const WorldId id = world.add(solver);
  const std::vector<BodyState> before = solver.states(id);
  const auto angular = [&](const std::vector<BodyState>& states) {
    Vec3 sum = Vec3::Zero();
    for (std::size_t b = 0; b < 3; ++b)
      sum += masses[b] * states[b].pose.position.cross(states[b].velocity.linear) +
             spin_momentum(states[b], world.shapes[0], masses[b]);
    return sum;
  };
  const auto energy = [&](const std::vector<BodyState>& states) {
    double sum = 0.0;
    for (std::size_t b = 0; b < 3; ++b) sum += kinetic(states[b], world.shapes[0], masses[b]);
    return sum;
  };
  double last = energy(before);
  for (int step = 0; step < 30; ++step) {
    solver.advance({id}, 0.01);
    const std::vector<BodyState> now = solver.states(id);
    EXPECT_LT((momentum(now, masses) - momentum(before, masses)).norm(), 1e-5);
    EXPECT_LT((angular(now) - angular(before)).norm(), 1e-5 * 0.02);  // momentum times a lever of two radii
    EXPECT_LT(energy(now), last * (1.0 + 1e-5)) << "step " << step;
    last = energy(now);
  }
  EXPECT_LT(last, 0.95 * energy(before)) << "they never met";
  EXPECT_GT(solver.profile().counters.at("contacts"), 0u);
}

TEST(ThesisPhysics, BallBouncesToTheSquareOfRestitution) {
  // A step sees the contact up to v dt too late and below the surface, which costs up to (1 - e^2) v dt of height:
  // at 16 sub-steps 0.2 mm of 162 mm. The tolerance is measures.md's 1 %.
  ThesisSolver solver(settings_with(1.0, 16));
  WorldBuilder world;
  world.floor();
  const double height = 0.2, radius = 0.02;
  world.body(world.shape(ball(radius)), Vec3(0, 0, radius + height), Vec3::Zero(), 0.1, 0.5, 0.9);
  const WorldId id = world.add(solver);
  double top = 0.0;
  bool bounced = false;
  for (int i = 0; i < 80; ++i) {
    solver.advance({id}, 0.005);
    const BodyState state = solver.states(id)[0];
    bounced = bounced || state.velocity.linear.z() > 0.5;
    if (bounced) top = std::max(top, state.pose.position.z() - radius);
  }
  EXPECT_NEAR(top, 0.81 * height, 0.01 * 0.81 * height);
}

TEST(ThesisPhysics, SlowContactsDoNotBounce) {
  ThesisSolver solver;
  WorldBuilder world;
  world.floor();
  const double radius = 0.02;
  world.body(world.shape(ball(radius)), Vec3(0, 0, radius), Vec3::Zero(), 0.1, 0.5, 0.9);
  const WorldId id = world.add(solver);
  solver.advance({id}, 0.2);  // while the bias takes the first overlap back
  for (int i = 0; i < 20; ++i) {
    solver.advance({id}, 0.01);
    EXPECT_LT(std::abs(solver.states(id)[0].velocity.linear.z()), 1e-3);
  }
}

/// A flat block on the floor, gravity tilted so that the floor is a slope.
WorldBuilder block_on_slope(double angle, double friction, double tightness, double speed) {
  WorldBuilder world;
  world.floor(friction);
  world.def.gravity = g * Vec3(std::sin(angle), 0, -std::cos(angle));
  const double radius = 0.005, pitch = 2.0 * radius * tightness;
  world.body(world.shape(block(4, 4, 2, radius, pitch)), Vec3(0.0, 0.0, radius + 0.5 * pitch), Vec3(speed, 0, 0), 0.1,
             friction);
  return world;
}

// The floor is a lattice of spheres, so a block rides up and down as it slides; with spheres that overlap by half
// (tightness 0.5) the ripple is 0.13 r high and takes less than 1 % off the distance. measures.md asks 0.5 %, of an
// analytic floor.
TEST(ThesisPhysics, SlidesAsFarAsFrictionLets) {
  const double v0 = 0.8, mu = 0.4, distance = v0 * v0 / (2.0 * mu * g);
  const ThesisSettings settings = settings_with(0.5, 4);
  ThesisSolver solver(settings);
  const WorldId id = block_on_slope(0.0, mu, 0.5, v0).add(solver, settings);
  solver.advance({id}, 0.5);
  const BodyState state = solver.states(id)[0];
  EXPECT_NEAR(state.pose.position.x(), distance, 0.01 * distance);
  EXPECT_LT(state.velocity.linear.norm(), 1e-3);
}

TEST(ThesisPhysics, SticksBelowAndSlidesAboveTheAngleOfFriction) {
  const double mu = 0.4;
  for (const double factor : {0.9, 1.1}) {
    const double angle = factor * std::atan(mu), tightness = 0.5;
    ThesisSettings settings = settings_with(tightness, 4);
    settings.iterations = 40;  // at 10, friction that has not converged creeps 1 mm and slides 12 % too far
    ThesisSolver solver(settings);
    const WorldId id = block_on_slope(angle, mu, tightness, 0.0).add(solver, settings);
    const double t = solver.advance({id}, 0.5);
    const double distance = solver.states(id)[0].pose.position.x();
    const double slide = 0.5 * g * (std::sin(angle) - mu * std::cos(angle)) * t * t;
    if (factor < 1.0) {
      EXPECT_LT(std::abs(distance), 5e-4);
    } else {
      EXPECT_NEAR(distance, slide, 0.03 * slide);
    }
  }
}

TEST(ThesisPhysics, TumblingKeepsEnergyAndMomentum) {
  // Spin about the middle axis is unstable (Dzhanibekov); explicit Euler gains energy until it is nonsense.
  ThesisSolver solver;
  WorldBuilder world;
  world.nothing();
  world.body(world.shape(block(5, 3, 1, 0.01, 0.02)), Vec3::Zero());
  world.starts[0].velocity.angular = Vec3(0.01, 5.0, 0.02);
  const WorldId id = world.add(solver);
  const BodyState before = solver.states(id)[0];
  const Vec3 l = spin_momentum(before, world.shapes[0], 1.0);
  const double e = kinetic(before, world.shapes[0], 1.0);
  bool flipped = false;
  for (int i = 0; i < 20; ++i) {
    solver.advance({id}, 0.5);
    const BodyState now = solver.states(id)[0];
    EXPECT_NEAR(kinetic(now, world.shapes[0], 1.0), e, 1e-3 * e);
    EXPECT_LT((spin_momentum(now, world.shapes[0], 1.0) - l).norm(), 1e-3 * l.norm());
    flipped = flipped || (now.pose.orientation * Vec3::UnitY()).y() < -0.5;
  }
  EXPECT_TRUE(flipped) << "the unstable axis never turned over: the test shows nothing";
}

TEST(ThesisPhysics, ATiltedCubeComesToRestFlat) {
  ThesisSolver solver;
  WorldBuilder world;
  world.floor();
  world.body(world.shape(cube(4, 0.005)), Vec3(0, 0, 0.05), Vec3(0.1, 0, 0), 0.1);
  world.starts[0].pose.orientation = Quat(Eigen::AngleAxisd(0.5, Vec3(1, 2, 3).normalized()));
  const WorldId id = world.add(solver);
  solver.advance({id}, 3.0);
  const Pose then = solver.states(id)[0].pose;
  solver.advance({id}, 0.25);
  const Pose now = solver.states(id)[0].pose;
  const double diagonal = 0.04 * std::sqrt(3.0);
  EXPECT_LT((now.position - then.position).norm(), 1e-3 * diagonal);  // the default of pour.rest_move
  EXPECT_LT(now.orientation.angularDistance(then.orientation), 1e-2);
  // Flat, at most one lattice hollow below the plane: r (2 - sqrt 2).
  EXPECT_LT(now.position.z(), 0.02 + 1e-4);
  EXPECT_GT(now.position.z(), 0.02 - 0.005 * (2.0 - std::sqrt(2.0)) - 1e-4);
}

TEST(ThesisPhysics, AStackComesToRest) {
  // Each layer sits in the hollows of the one below: ball on ball is no equilibrium, neither here nor in nature.
  // At rest a stack as loaded as this one needs more than the default iterations ("more for higher stacks").
  ThesisSettings settings = settings_with(1.0, 4);
  settings.iterations = 20;
  ThesisSolver solver(settings);
  WorldBuilder world;
  world.floor();
  const double r = 0.005, rise = std::sqrt(2.0) * r;
  const std::size_t shape = world.shape(block(4, 4, 2, r, 2.0 * r));
  for (int i = 0; i < 3; ++i)
    world.body(shape, Vec3(i % 2 ? r : 0.0, i % 2 ? r : 0.0, 2.0 * r + i * (2.0 * r + rise) + 0.0005 * (i + 1)),
               Vec3::Zero(), 0.1);
  const WorldId id = world.add(solver);
  solver.advance({id}, 2.0);
  const std::vector<BodyState> then = solver.states(id);
  solver.advance({id}, 0.25);
  const std::vector<BodyState> now = solver.states(id);
  for (int i = 0; i < 3; ++i) {
    EXPECT_LT((now[i].pose.position - then[i].pose.position).norm(), 1e-3 * 0.06) << "body " << i;
    EXPECT_LT(now[i].pose.orientation.angularDistance(then[i].pose.orientation), 1e-2);
    const double below = i ? now[i - 1].pose.position.z() : -2.0 * r;  // as if the floor's layer were a block's upper
    EXPECT_NEAR(now[i].pose.position.z() - below, 2.0 * r + rise, 0.1 * r) << "body " << i;
  }
}

// Bodies in a pile have many neighbours; were each given the whole of a body's mass, iterations would add up to more
// than is needed and throw the pile apart.
TEST(ThesisPhysics, MoreIterationsNeverThrowAPileApart) {
  for (const int iterations : {10, 40}) {
    ThesisSettings settings;
    settings.iterations = iterations;
    ThesisSolver solver(settings);
    WorldBuilder world;
    world.def.bin.inner_size = Vec3(0.08, 0.08, 0.3);
    const std::size_t shape = world.shape(cube(3, 0.005));
    for (int i = 0; i < 12; ++i) {
      world.body(shape, Vec3((i % 2 - 0.5) * 0.04, (i / 2 % 2 - 0.5) * 0.04, 0.02 + i / 4 * 0.04), Vec3::Zero(), 0.1);
      world.starts.back().pose.orientation = Quat(Eigen::AngleAxisd(0.3 + 0.2 * i, Vec3(1, i % 3, 2).normalized()));
    }
    const WorldId id = world.add(solver, settings);
    solver.advance({id}, 1.0);
    double fastest = 0.0, highest = 0.0;
    for (int look = 0; look < 10; ++look) {
      solver.advance({id}, 0.05);
      for (const BodyState& state : solver.states(id)) {
        fastest = std::max(fastest, state.velocity.linear.norm());
        highest = std::max(highest, state.pose.position.z());
      }
    }
    EXPECT_LT(fastest, 0.1) << iterations;  // a step of gravity, m/s
    EXPECT_LT(highest, 0.12) << iterations;
  }
}

}  // namespace
}  // namespace bin_scenes::thesis::test
