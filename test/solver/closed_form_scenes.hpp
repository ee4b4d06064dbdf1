/// Scenes with an answer in closed form, as numbers: tests hold them to a tolerance, the benchmark closed_forms prints
/// them over time steps. SI units; what is relative says so.
#pragma once

#include "pour/settling.hpp"
#include "solver/lab.hpp"

#include <algorithm>
#include <functional>
#include <vector>

namespace bin_scenes::testing {

constexpr double g = 9.81;

struct Fall {
  double distance, speed;  ///< errors / exact value
};
/// A box thrown up and along, for one second.
inline Fall free_fall(Lab lab) {
  lab.def().bin.kind = Bin::Kind::none;
  const Vec3 from(0.1, 0.2, 0.3);
  const auto body = lab.place(box({0.05, 0.03, 0.02}), from);
  lab.start(body).velocity.linear = Vec3(0.5, 0.0, 1.0);
  lab.simulate(1.0);
  const double t = lab.time(), speed = 1.0 - g * t;
  const Vec3 expected(0.5 * t, 0.0, t - 0.5 * g * t * t);
  return {(lab.center(body) - from - expected).norm() / expected.norm(),
          std::abs((lab.state(body).velocity.linear.z() - speed) / speed)};
}

/// Height that a ball reaches after its first bounce / height it was let go from; restitution squared.
inline double bounce(Lab lab, double drop, double restitution) {
  const double radius = 0.025;
  const auto ball = lab.place(sphere(radius), Vec3(0, 0, radius + drop), Quat::Identity(), material(0.5, restitution));
  double peak = 0.0;
  while (lab.time() < 3.0 * std::sqrt(2.0 * drop / g)) {
    lab.simulate(lab.solver().step_size());
    const double speed = lab.state(ball).velocity.linear.z();
    if (speed < 0.0 && peak > 0.0) break;
    if (speed > 0.0) peak = std::max(peak, lab.center(ball).z() - radius);
  }
  return peak / drop;
}

/// A ball that loses nothing bounces from a metre for five seconds: largest change of its energy / m g h. From a step
/// that it is in the air for.
inline double elastic_change(Lab lab) {
  const double radius = 0.025, height = 1.0;
  const auto ball = lab.place(sphere(radius), Vec3(0, 0, radius + height), Quat::Identity(), material(0.0, 1.0));
  double most = 0.0;
  while (lab.time() < 5.0) {
    lab.simulate(lab.solver().step_size());
    const double energy = lab.kinetic_energy(ball) + g * (lab.center(ball).z() - radius);
    if (lab.center(ball).z() > 0.1 * height) most = std::max(most, std::abs(energy / (g * height) - 1.0));
  }
  return most;
}

struct Carried {
  double force, moment;  ///< errors / weight of both, / that and the diagonal
};
/// A block lies on another off its middle, on a slope: what each is carried with.
inline Carried carry(Lab lab) {
  const Vec3 low(0.06, 0.06, 0.03), high(0.03, 0.03, 0.02);
  lab.def().gravity = Quat(Eigen::AngleAxisd(0.3, Vec3(1, 2, 0).normalized())) * Vec3(0, 0, -g);
  lab.def().bin.friction = 0.8;
  const auto below = lab.place(box(low), Vec3(0, 0, 0.5 * low.z()), Quat::Identity(), material(0.8, 0.0, 2.0));
  const auto above =
      lab.place(box(high), Vec3(0.01, -0.01, low.z() + 0.5 * high.z()), Quat::Identity(), material(0.8, 0.0, 1.0));
  lab.begin(phases::press);
  lab.simulate(1.0);
  const Vec3 weight = lab.def().gravity;  // of a kilogram
  const Lab::Wrench up = lab.wrench(above, static_cast<int>(below)), down = lab.wrench(below, static_cast<int>(above));
  const Lab::Wrench ground = lab.wrench(below, -1);
  const double size = low.norm(), all = 3.0 * g;
  return {std::max((up.force + weight).norm(), (ground.force + 3.0 * weight).norm()) / all,
          std::max(up.moment.norm(), (ground.moment + down.moment).norm()) / (all * size)};
}

struct Slide {
  double distance;  ///< error / exact distance
  double aside;     ///< of the direction, rad
  double speed;     ///< left over, m/s
};
/// A flat box that friction stops: v0^2 / (2 mu g), straight on.
inline Slide slide(Lab lab, double friction_of_bin = 0.45, double friction_of_box = 0.2) {
  lab.def().bin.friction = friction_of_bin;
  const auto body = lab.place(box({0.05, 0.04, 0.01}), Vec3(0, 0, 0.005), Quat::Identity(), material(friction_of_box));
  lab.start(body).velocity.linear = Vec3(0.8, 0.6, 0.0);
  lab.simulate(1.0);
  const double mu = std::sqrt(friction_of_bin * friction_of_box), expected = 1.0 / (2.0 * mu * g);
  const Vec3 end = lab.center(body);
  return {std::abs(end.head<2>().norm() / expected - 1.0),
          std::abs(std::atan2(end.y(), end.x()) - std::atan2(0.6, 0.8)), lab.state(body).velocity.linear.norm()};
}

/// m that a flat box with mu = 0.5 slips down a slope in one second. A tilted gravity stands for it; `heading` is the
/// direction down it, which must not matter.
inline double slip(Lab lab, double angle, double heading, Phase phase = phases::pour) {
  lab.def().gravity =
      g * Vec3(std::sin(angle) * std::cos(heading), std::sin(angle) * std::sin(heading), -std::cos(angle));
  const auto body = lab.place(box({0.05, 0.05, 0.01}), Vec3(0, 0, 0.005), Quat::Identity(), material(0.5));
  lab.begin(phase);
  lab.simulate(1.0);
  return lab.center(body).head<2>().norm();
}

/// A ball that rolls down 15 degrees for one second: error / distance, from the tessellated body's own moment of
/// inertia (5/7 g sin(angle) for an ideal ball).
inline double roll(Lab lab) {
  const double angle = 15.0 * M_PI / 180.0, radius = 0.025;
  lab.def().gravity = g * Vec3(std::sin(angle), 0.0, -std::cos(angle));
  const PartModelPtr ball = sphere(radius);
  const auto body = lab.place(ball, Vec3(0, 0, radius), Quat::Identity(), material(0.5));
  lab.simulate(1.0);
  const double k = ball->mass().principal.mean() / (ball->mass().volume * radius * radius);
  const double expected = 0.5 * g * std::sin(angle) / (1.0 + k) * lab.time() * lab.time();
  return std::abs(lab.center(body).x() / expected - 1.0);
}

/// A ball at rest on a plate that slides under it, and takes it along until it rolls: speed of the ball / what it is
/// then, k / (1 + k) of the plate's, where k m r2 is its moment of inertia; error after two seconds.
inline double ride(Lab lab) {
  const double radius = 0.1;
  lab.def().bin.friction = 0.0;
  const PartModelPtr ball = sphere(radius);
  const auto plate = lab.place(box({2.0, 0.2, 0.05}), Vec3(0, 0, 0.025), Quat::Identity(), material(0.5, 0.0, 10.0));
  const auto body = lab.place(ball, Vec3(0, 0, 0.05 + radius), Quat::Identity(), material(0.5));
  lab.start(plate).velocity.linear = Vec3(0.2, 0, 0);
  lab.simulate(2.0);
  const double k = ball->mass().principal.mean() / (ball->mass().volume * radius * radius);
  return std::abs(lab.state(body).velocity.linear.x() / lab.state(plate).velocity.linear.x() * (1.0 + k) / k - 1.0);
}

/// A ball that spins where it lies, with friction 0.5: what it loses in half a second / what a contact does that is an
/// evenly pressed patch of radius `patch` (share of the ball's diagonal), 2/3 friction patch m g / I a second.
inline double spin_lost(Lab lab, double patch) {
  const double spin = 5.0;
  const PartModelPtr ball = sphere(0.025);
  const auto body = lab.place(ball, Vec3(0, 0, 0.025), Quat::Identity(), material(0.5));
  lab.simulate(0.25);  // it lies
  BodyState spinning = lab.state(body);
  spinning.velocity.angular = Vec3(0, 0, spin);
  lab.set_state(body, spinning);
  lab.simulate(0.5);
  const double moment = ball->mass().principal.mean() / ball->mass().volume;  // of 1 kg
  return (spin - lab.state(body).velocity.angular.z()) /
         (0.5 * 2.0 / 3.0 * 0.5 * patch * ball->diagonal() * g / moment);
}

/// A yoke that swings about the ridge it hangs on loses 2 patch / (depth of its centre of mass) of its amplitude in
/// each half swing where the line of contact is as wide as `patch` (share of the smaller diagonal), for that resists by
/// patch x force as sliding friction would. Loss of eight half swings over that.
inline double swing_lost(Lab lab, double patch) {
  const PartModelPtr blade = box({0.02, 0.06, 0.02});
  const PartModelPtr yoke = PartModel::from_mesh(
      merged(box_mesh({0.06, 0.02, 0.01}, {0, 0, 0.005}), merged(box_mesh({0.01, 0.02, 0.05}, {-0.025, 0, -0.025}),
                                                                 box_mesh({0.01, 0.02, 0.05}, {0.025, 0, -0.025}))),
      "yoke");
  const Vec3 ridge(0, 0, 0.1);
  BodyDef held = material(0.5);
  held.fixed = true;
  const auto about_y = [](double turn) { return Quat(Eigen::AngleAxisd(turn, Vec3::UnitY())); };
  lab.place(blade, ridge - Vec3(0, 0, 0.02 * std::sqrt(0.5)), about_y(M_PI / 4), held);
  const Quat start = about_y(0.2);
  const auto body = lab.place(yoke, ridge + start * yoke->mass().center, start, material(0.5));
  const auto turn = [&] { return 2.0 * std::asin(lab.state(body).pose.orientation.y()); };
  std::vector<double> amplitudes = {0.2};
  double before = 0.2, rising = -1.0;
  while (amplitudes.size() < 9 && lab.time() < 10.0) {
    lab.simulate(lab.solver().step_size());
    const double now = turn();
    if ((now - before) * rising < 0) {
      amplitudes.push_back(std::abs(before));
      rising = -rising;
    }
    before = now;
  }
  const double per_half_swing = (amplitudes.front() - amplitudes.back()) / static_cast<double>(amplitudes.size() - 1);
  const double size = std::min(blade->diagonal(), yoke->diagonal());
  return per_half_swing / (2.0 * patch * size / -yoke->mass().center.z());
}

struct Collision {
  double momentum;  ///< largest change / sum of the two
  double spin;      ///< change of the angular momentum / (momentum times a box edge)
  double energy;    ///< highest / at the start; above 1 = gained
  double push;      ///< change of the first body's velocity, m/s: 0 = they did not meet
};
/// Two boxes that meet off centre, with friction 0.4.
inline Collision collide(Lab lab, double restitution) {
  lab.def().bin.kind = Bin::Kind::none;
  lab.def().gravity.setZero();
  const auto a = lab.place(box({0.05, 0.03, 0.02}), Vec3(-0.06, 0.004, 0.002),
                           Quat(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized())), material(0.4, restitution, 0.3));
  const auto b = lab.place(box({0.04, 0.04, 0.04}), Vec3(0.06, 0, 0), Quat::Identity(), material(0.4, 0.0, 0.2));
  lab.start(a).velocity.linear = Vec3(0.8, 0.0, 0.0);
  lab.start(b).velocity.linear = Vec3(-0.5, 0.0, 0.0);
  lab.start(b).velocity.angular = Vec3(0, 3, 5);
  const auto energy = [&] { return lab.kinetic_energy(a) + lab.kinetic_energy(b); };
  const auto momentum = [&] { return Vec3(lab.momentum(a) + lab.momentum(b)); };
  const auto spin = [&] {
    return Vec3(lab.spin(a) + lab.spin(b) + lab.center(a).cross(lab.momentum(a)) +
                lab.center(b).cross(lab.momentum(b)));
  };
  lab.simulate(lab.solver().step_size());
  const Vec3 momentum_before = momentum(), spin_before = spin();
  const double energy_before = energy(), speed = lab.state(a).velocity.linear.x();
  double highest = energy_before;
  while (lab.time() < 0.3) {
    lab.simulate(lab.solver().step_size());
    highest = std::max(highest, energy());
  }
  return {(momentum() - momentum_before).norm() / (0.3 * 0.8 + 0.2 * 0.5),
          (spin() - spin_before).norm() / (0.24 * 0.05), highest / energy_before,
          std::abs(lab.state(a).velocity.linear.x() - speed)};
}

struct Tumble {
  double lowest, highest;  ///< kinetic energy / that of the first step
  double spin;             ///< largest change of |L| / |L|
  double turned;           ///< lowest cosine between the middle axis and where it pointed: near -1 = it turned over
};
/// Dzhanibekov: a body that turns about its middle axis tumbles for ten seconds.
inline Tumble tumble(Lab lab) {
  lab.def().bin.kind = Bin::Kind::none;
  lab.def().gravity.setZero();
  const auto body = lab.place(box({0.06, 0.03, 0.01}), Vec3::Zero());
  lab.start(body).velocity.angular = Vec3(0.01, 8.0, 0.01);
  lab.simulate(lab.solver().step_size());
  const double energy = lab.kinetic_energy(body), spin = lab.spin(body).norm();
  Tumble result{1.0, 1.0, 0.0, 1.0};
  const double step = lab.solver().step_size(), look = step * std::max(1.0, std::round(0.02 / step));  // nothing cut
  while (lab.time() < 10.0) {
    lab.simulate(look);
    result.lowest = std::min(result.lowest, lab.kinetic_energy(body) / energy);
    result.highest = std::max(result.highest, lab.kinetic_energy(body) / energy);
    result.spin = std::max(result.spin, std::abs(lab.spin(body).norm() / spin - 1.0));
    result.turned = std::min(result.turned, (lab.state(body).pose.orientation * Vec3::UnitY()).y());
  }
  return result;
}

/// What a body that nothing touches loses while it turns by tens of radians.
struct FreeTurn {
  double momentum = 0.0;  ///< largest change of the vector of the angular momentum / its length
  double energy = 0.0;    ///< largest change of the kinetic energy / kinetic energy
  double rate = 0.0;      ///< error of how fast it turns / exact value
};
/// Simulates a body alone for `seconds`, which turns at `spin` (rad/s), and calls `look(lab)` after each step.
template <class Look>
FreeTurn turn_freely(Lab& lab, const PartModelPtr& part, const Vec3& spin, double seconds, const Look& look) {
  lab.def().bin.kind = Bin::Kind::none;
  lab.def().gravity.setZero();
  lab.place(part, Vec3::Zero());
  lab.start(0).velocity.angular = spin;
  const Vec3 momentum = lab.spin(0, lab.start(0));
  const double energy = lab.kinetic_energy(0, lab.start(0));
  FreeTurn result;
  while (lab.time() < seconds) {
    lab.simulate(lab.solver().step_size());
    result.momentum = std::max(result.momentum, (lab.spin(0) - momentum).norm() / momentum.norm());
    result.energy = std::max(result.energy, std::abs(lab.kinetic_energy(0) / energy - 1.0));
    look(lab);
  }
  return result;
}

/// A disc with this diameter (m) that spins about an axis close to its own. Both its axis and the disc about it turn
/// evenly (Landau and Lifshitz, Mechanics, paragraph 35): q(t) = exp(L t / I1) exp(w3 (1 - I3 / I1) t e3).
inline FreeTurn spin_freely(Lab lab, double size) {
  const double unit = std::sqrt(size / g), w1 = 3.0 / unit, w3 = 15.0 / unit;
  const PartModelPtr disc = PartModel::from_mesh(prism_mesh(24, 0.5 * size, -0.1 * size, 0.1 * size), "disc");
  const Mat3 inertia = disc->mass().inertia;
  const Vec3 mean = Vec3(w1, 0.0, inertia(2, 2) / inertia(0, 0) * w3);  // L / I1
  const double own = w3 * (1.0 - inertia(2, 2) / inertia(0, 0));
  FreeTurn result = turn_freely(lab, disc, Vec3(w1, 0.0, w3), 6.0 * unit, [](const Lab&) {});
  const Quat exact = Quat(Eigen::AngleAxisd(mean.norm() * lab.time(), mean.normalized())) *
                     Quat(Eigen::AngleAxisd(own * lab.time(), Vec3::UnitZ()));
  result.rate = lab.state(0).pose.orientation.angularDistance(exact) / (mean.norm() * lab.time());
  return result;
}

/// A board with this length (m) that spins about its middle axis and turns over again and again (Dzhanibekov). Its spin
/// about that axis is b sn(t l, k), with half a period of 2 K(k) / l between two changes of its sign (Landau and
/// Lifshitz, paragraph 37).
inline FreeTurn turn_over_freely(Lab lab, double size) {
  const double unit = std::sqrt(size / g);
  const PartModelPtr board = box(Vec3(1.0, 0.6, 0.2) * size);
  const Vec3 spin = Vec3(2.0, 20.0, 0.0) / unit, inertia = board->mass().inertia.diagonal();
  const double energy = inertia.dot(spin.cwiseAbs2()), momentum = inertia.cwiseProduct(spin).squaredNorm();  // 2 T, L^2
  const double low = momentum - energy * inertia[0], high = energy * inertia[2] - momentum;
  const double rate = std::sqrt((inertia[1] - inertia[0]) * high / inertia.prod());
  const double modulus = std::sqrt((inertia[2] - inertia[1]) * low / ((inertia[1] - inertia[0]) * high));
  const double half = 2.0 * std::comp_ellint_1(modulus) / rate;
  const double most = std::sqrt(low / (inertia[1] * (inertia[1] - inertia[0])));  // b
  double before = spin.y(), since = 0.0, last = 0.0;
  int turns = 0;
  FreeTurn result = turn_freely(lab, board, spin, 24.0 * unit, [&](const Lab& now) {
    const BodyState state = now.state(0);
    const double about = (state.pose.orientation.conjugate() * state.velocity.angular).y();
    if (about * before < 0.0) {
      const bool earlier = std::abs(before) < std::abs(about);
      const double share = (earlier ? before : about) / std::copysign(most, about);
      last = (earlier ? since : now.time()) - std::ellint_1(modulus, std::asin(share)) / rate;
      ++turns;
    }
    before = about;
    since = now.time();
  });
  result.rate = std::abs(last / ((turns - 0.5) * half) - 1.0);  // the first half began in its middle
  return result;
}

/// Boxes on each other for `seconds`, turned by `heading` about the vertical: largest displacement of any / edge.
inline double stack_drift(Lab lab, double seconds, double heading = 0.0, const Vec3& size = Vec3::Constant(0.04),
                          int count = 10) {
  const double edge = size.z();
  const PartModelPtr brick = box(size);
  const auto start = [&](int i) { return Vec3(0, 0, (i + 0.5) * edge); };
  const Quat turned(Eigen::AngleAxisd(heading, Vec3::UnitZ()));
  for (int i = 0; i < count; ++i) lab.place(brick, start(i), turned, material(0.5));
  lab.begin(phases::press);  // as every scene ends
  lab.simulate(seconds);
  double most = 0.0;
  for (int i = 0; i < count; ++i)
    most = std::max(most, (lab.center(static_cast<std::size_t>(i)) - start(i)).norm() / edge);
  return most;
}

/// Drift of stacks of ten other boxes: five edges, as wide as high and wider, turned and not.
inline std::vector<double> brick_stack_drifts(const std::function<Lab()>& lab, double seconds) {
  std::vector<double> drifts;
  for (const double edge : {0.02, 0.03, 0.04, 0.05, 0.08})
    for (const double width : {1.0, 1.5, 2.5})
      for (const double heading : {0.0, 0.3, 0.7})
        drifts.push_back(stack_drift(lab(), seconds, heading, Vec3(width * edge, edge, edge)));
  return drifts;
}

struct Rods {
  double first, second;  ///< speeds along the impact afterwards / speed of the first before: 0 and 1
};
/// The thesis's figures 3.2 to 3.4: a rod that meets another with many contacts at once exchanges no more than one.
inline Rods meet_along_rods(Lab lab) {
  lab.def().bin.kind = Bin::Kind::none;
  lab.def().gravity.setZero();
  const double speed = 0.4;
  const PartModelPtr rod = box({0.06, 0.01, 0.01});
  const auto a = lab.place(rod, Vec3(0, 0, -0.02), Quat::Identity(), material(0.0, 1.0));
  const auto b = lab.place(rod, Vec3(0, 0, 0.02), Quat::Identity(), material(0.0, 1.0));
  lab.start(a).velocity.linear = Vec3(0, 0, speed);
  lab.simulate(0.2);
  return {lab.state(a).velocity.linear.z() / speed, lab.state(b).velocity.linear.z() / speed};
}

}  // namespace bin_scenes::testing
