/// Contacts that are hard to solve: fast, uneven in mass, sharp or tight. As numbers, like closed_form_scenes.hpp.
#pragma once

#include "bin_scenes/core/random.hpp"
#include "solver/closed_form_scenes.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes::testing {

/// A box thrown down a kilometre of air at 1,000 m/s, for one second.
inline Fall long_flight(Lab lab) {
  lab.def().bin.kind = Bin::Kind::none;
  const auto body = lab.place(box({0.05, 0.03, 0.02}), Vec3::Zero());
  const Vec3 start(600.0, 0.0, -800.0);
  lab.start(body).velocity.linear = start;
  lab.simulate(1.0);
  const double t = lab.time();
  const Vec3 fallen = t * start - Vec3(0, 0, 0.5 * g * t * t), velocity = start - Vec3(0, 0, g * t);
  return {(lab.center(body) - fallen).norm() / fallen.norm(),
          (lab.state(body).velocity.linear - velocity).norm() / velocity.norm()};
}

/// Two bricks that tumble, of unequal mass, strike each other off centre: change of the angular momentum about the
/// common centre of mass / sum of its parts at the start.
inline double spin_gained_in_an_impact(Lab lab, std::uint64_t seed) {
  Random random(seed, 0, Stream::probe);
  const auto any = [&] { return Vec3(random.normal(), random.normal(), random.normal()); };
  lab.def().bin.kind = Bin::Kind::none;
  lab.def().gravity.setZero();
  const double restitution = random.uniform(), friction = random.uniform();
  for (const double side : {-1.0, 1.0}) {
    const double width = random.uniform(0.02, 0.08);
    const auto body = lab.place(box({0.1, width, 0.04}), Vec3(0.1 * side, 0, 0) + 0.01 * any(), random.orientation(),
                                material(friction, restitution, random.uniform(0.1, 1.0)));
    lab.start(body).velocity = {Vec3(-side, 0, 0) + 0.1 * any(), 5.0 * any()};
  }
  double scale = 0.0;
  const auto total = [&](const std::vector<BodyState>& states) {
    Vec3 sum = Vec3::Zero();
    scale = 0.0;
    for (std::size_t b = 0; b < states.size(); ++b) {
      const Vec3 momentum = lab.body(b).mass * states[b].velocity.linear, spin = lab.spin(b, states[b]);
      sum += spin + (states[b].pose * lab.part(b).mass().center).cross(momentum);
      scale += spin.norm() + lab.part(b).diagonal() * momentum.norm();
    }
    return sum;
  };
  const Vec3 before = total({lab.start(0), lab.start(1)});
  const double scale_before = scale;
  lab.simulate(0.25);
  return (total(lab.states()) - before).norm() / scale_before;
}

/// A coin of many sides rolls round on its rim, its centre at rest, tilted by 30 degrees: time until half of its energy
/// is lost / that of a rigid polygon. Its energy is 1.5 m g R s, s the sine of the tilt (Moffatt 2000, "Euler's disk
/// and its finite-time singularity"); the contact goes round at sqrt(4 g / (R s)). The next corner, of the polygon's
/// angle a ahead, comes down at w R a, w the coin's speed of turning, and its share of the mass is 1/5: each corner
/// takes 0.4 m g R s a^2.
inline double half_life_of_a_coin(Lab lab, std::uint32_t sides, double radius) {
  const double thickness = radius / 12.0, tilt = M_PI / 6.0, s = std::sin(tilt), angle = 2.0 * M_PI / sides;
  lab.def().bin.friction = 1.0;
  const PartModelPtr coin = PartModel::from_mesh(prism_mesh(sides, radius, -0.5 * thickness, 0.5 * thickness), "coin");
  const double height = radius * s + 0.5 * thickness * std::cos(tilt);
  const auto body = lab.place(coin, Vec3(0, 0, height), Quat(Eigen::AngleAxisd(tilt, Vec3::UnitX())), material(1.0));
  lab.start(body).velocity.angular = std::sqrt(4.0 * g * s / radius) * Vec3(0, std::cos(tilt), s);
  const auto energy = [&] { return lab.kinetic_energy(body) + g * (lab.center(body).z() - 0.5 * thickness); };
  lab.begin(phases::pour);
  const double half = 0.5 * energy(),
               polygon = (1.0 - std::sqrt(0.5)) * std::sqrt(s * radius / g) / (0.8 / 3.0 * angle);
  while (energy() > half && lab.time() < 4.0 * polygon) lab.simulate(lab.solver().step_size());
  return lab.time() / polygon;
}

struct Rebound {
  double speed;         ///< fastest upwards after the impact, m/s
  double aside;         ///< farthest that a cube went sideways / edge
  double height;        ///< least distance of neighbours above each other / edge: below 1 = sunk in
  double thrown = 0.0;  ///< fastest of what lay there / speed of the impact
};
/// A cube at 3.2 m/s onto a light one that lies on the floor, `offset` (edges) aside.
inline Rebound strike_light_cube(Lab lab, double mass, double offset = 0.0) {
  const double edge = 0.05;
  const PartModelPtr cube = box(Vec3::Constant(edge));
  const auto light = lab.place(cube, Vec3(0, 0, 0.5 * edge), Quat::Identity(), material(0.5));
  const auto heavy = lab.place(cube, Vec3(offset * edge, 0, 1.7 * edge), Quat::Identity(), material(0.5, 0.0, mass));
  const double speed = 3.2;
  lab.start(heavy).velocity.linear = Vec3(0, 0, -speed);
  Rebound out{0.0, 0.0, 1.0};
  while (lab.time() < 0.5) {
    lab.simulate(lab.solver().step_size());
    out.speed = std::max(out.speed, lab.state(heavy).velocity.linear.z());
    out.aside = std::max(out.aside, lab.center(light).head<2>().norm() / edge);
    out.thrown = std::max(out.thrown, lab.state(light).velocity.linear.norm() / speed);
    out.height = std::min(out.height, (lab.center(heavy).z() - lab.center(light).z()) / edge);
  }
  return out;
}

/// Two cubes of `ratio` times the mass of a third one, `gap` (edges) from it, strike it from both sides at once:
/// fastest that it is / their speed. Exactly, nothing moves afterwards.
inline double asymmetry_of_impact(Lab lab, double edge, double ratio, double gap) {
  lab.def().bin.kind = Bin::Kind::none;
  lab.def().gravity.setZero();
  const PartModelPtr cube = box(Vec3::Constant(edge));
  const double mass = 1000.0 * edge * edge * edge, speed = 14.0 * std::sqrt(edge);
  const auto light = lab.place(cube, Vec3::Zero(), Quat::Identity(), material(0.5, 0.0, mass));
  for (const double side : {-1.0, 1.0}) {
    const auto heavy =
        lab.place(cube, Vec3((1.0 + gap) * side * edge, 0, 0), Quat::Identity(), material(0.5, 0.0, ratio * mass));
    lab.start(heavy).velocity.linear = Vec3(-side * speed, 0, 0);
  }
  double most = 0.0;
  while (lab.time() < 0.3) {
    lab.simulate(lab.solver().step_size());
    most = std::max(most, lab.state(light).velocity.linear.norm());
  }
  return most / speed;
}

/// A channel along y, `size` wide, 0.4 of it long and 0.7 high, open above. Its floor and its two walls are 0.16 thick.
inline PartModelPtr channel(double size) {
  const double xs[] = {-0.5, 0.5, 0.5, 0.34, 0.34, -0.34, -0.34, -0.5}, zs[] = {0, 0, 0.7, 0.7, 0.16, 0.16, 0.7, 0.7};
  Mesh mesh;
  for (const double y : {-0.2, 0.2})
    for (int i = 0; i < 8; ++i) mesh.vertices.emplace_back(size * xs[i], size * y, size * zs[i]);
  for (std::uint32_t i = 0; i < 8; ++i) {
    const std::uint32_t j = (i + 1) % 8;
    mesh.triangles.insert(mesh.triangles.end(), {{i, j + 8, j}, {i, i + 8, j + 8}});
  }
  for (const Triangle& t : {Triangle{0, 1, 4}, Triangle{0, 4, 5}, Triangle{1, 2, 4}, Triangle{2, 3, 4},
                            Triangle{0, 5, 7}, Triangle{5, 6, 7}})
    mesh.triangles.insert(mesh.triangles.end(), {t, {t[0] + 8, t[2] + 8, t[1] + 8}});
  return PartModel::from_mesh(mesh, "channel");
}

/// A bar flies into a fixed channel, so that its lower front edge arrives near the place where a wall, the floor and an
/// end of the channel meet: how deep the edges of wall and floor there get into the bar / d. Negative if the bar of
/// this seed overlaps the channel already at the start. `channel`: of this size.
inline double overlap_beside_a_saddle(Lab lab, const PartModelPtr& channel, double size, std::uint64_t seed) {
  Random random(seed, 0, Stream::probe);
  lab.def().bin.kind = Bin::Kind::none;
  lab.def().gravity.setZero();
  BodyDef fixed = material(0.0);
  fixed.fixed = true;
  lab.place(channel, channel->mass().center, Quat::Identity(), fixed);
  const Vec3 bar = size * Vec3(1.2, 0.4, 0.3), saddle = size * Vec3(-0.34, 0.2, 0.16);
  const double yaw = random.uniform(0.1, 1.4), pitch = random.uniform(0.0, 1.0), roll = random.uniform(-0.7, 0.7);
  Mat3 axes;  // along the bar, to its front, up
  axes.col(0) = (Vec3(std::sin(yaw), -std::cos(yaw), 0) + std::tan(pitch) * Vec3::UnitZ()).normalized();
  axes.col(1) = Eigen::AngleAxisd(roll, Vec3(axes.col(0))) * Vec3(-std::cos(yaw), -std::sin(yaw), 0);
  axes.col(2) = Vec3(axes.col(0)).cross(Vec3(axes.col(1)));
  const double up = axes(2, 2) < 0.0 ? -1.0 : 1.0;
  const double speed = 7.0 * std::sqrt(size), seconds = random.uniform(0.2, 0.3) * size / speed;
  const Vec3 velocity = speed * Vec3(-1, random.uniform(-0.3, 0.3), -random.uniform(0.0, 0.6));
  const Vec3 to_edge(random.uniform(-0.3, 0.3) * size, 0.5 * bar.y(), -0.5 * up * bar.z());
  const Vec3 start = saddle - axes * to_edge - seconds * velocity + random.uniform(-0.03, 0.03) * size * Vec3::UnitZ();
  const auto is_inside = [&](const Vec3& point) {
    const Vec3 p = point / size;
    const bool within = std::abs(p.y()) < 0.2 && p.z() > 0.0 && p.z() < 0.7 && std::abs(p.x()) < 0.5;
    return within && (p.z() < 0.16 || std::abs(p.x()) > 0.34);
  };
  for (int i = 0; i <= 40; ++i)
    for (const double y : {-0.5, 0.0, 0.5})
      for (const double z : {-0.5, 0.0, 0.5})
        if (is_inside(start + axes * bar.cwiseProduct(Vec3(i / 40.0 - 0.5, y, z)))) return -1.0;
  const auto depth_at = [&](const Pose& pose) {
    double most = 0.0;
    for (int i = 0; i <= 200; ++i)
      for (const Vec3& edge : {Vec3(0, 0, 0.54), Vec3(0.68, 0, 0)}) {
        const Vec3 p = pose.inverse() * (saddle + i / 200.0 * size * edge);
        most = std::max(most, (0.5 * bar - p.cwiseAbs()).minCoeff() / bar.norm());
      }
    return most;
  };
  if (depth_at({start, Quat(axes)}) > 0.0) return -1.0;
  const auto body = lab.place(box(bar), start, Quat(axes), material(0.0));
  lab.start(body).velocity.linear = velocity;
  double deepest = 0.0;
  while (lab.time() < 2.0 * seconds) {
    lab.simulate(lab.solver().step_size());
    deepest = std::max(deepest, depth_at(lab.state(body).pose));
  }
  return deepest;
}

/// Lengths without a unit are in sizes, angles in rad.
struct Leaning {
  double size = 0.1;  ///< m, height of the bin and half its width
  double width = 0.04, roll = 0.0, yaw = 0.0;
  double lean = 1.0;  ///< angle of the bar to the floor
};
/// A flat bar with its lower end on the floor of a bin and its face on the rim, over which it falls by a few hundredths
/// of its width: time after which it rests for ten units / unit, sqrt(size / g); 100 at the most.
inline double time_to_rest_on_the_rim(Lab lab, const Leaning& leaning) {
  const double size = leaning.size, width = leaning.width * size, unit = std::sqrt(size / g);
  lab.def().bin.kind = Bin::Kind::box;
  lab.def().bin.inner_size = size * Vec3(2.0, 2.0, 1.0);
  lab.def().bin.friction = 0.8;
  lab.def().wall_height = size;
  const Vec3 bar = Vec3(1.6 * size, width, 0.04 * size), rim(size, 0, size);
  const Vec3 foot = rim - size * Vec3(1.0 / std::tan(leaning.lean), 0, 1.0);
  const Quat turn = Quat(Eigen::AngleAxisd(leaning.yaw, Vec3::UnitZ())) *
                    Quat(Eigen::AngleAxisd(-leaning.lean, Vec3::UnitY())) *
                    Quat(Eigen::AngleAxisd(leaning.roll, Vec3::UnitX()));
  const double above = 0.5 * bar.z() + 0.5 * width * leaning.roll;
  const Vec3 center = foot + turn * (0.5 * Vec3(bar.x(), 0, bar.z())) + Vec3(0, 0, above);
  const auto body = lab.place(box(bar), center, turn, material(0.8, 0.0, 0.1));
  lab.begin(phases::verify);
  double moving = 0.0;
  while (lab.time() < std::min(100.0, moving / unit + 10.0) * unit) {
    lab.simulate(lab.solver().step_size());
    if (lab.state(body).velocity.angular.norm() > 2e-3 / unit) moving = lab.time();
  }
  return moving / unit;
}

struct Stood {
  double deepest = 0.0;  ///< overlap at any time / d
  double moved = 0.0;    ///< farthest that the light one went sideways / edge
  bool rests = false;    ///< both are asleep in the end
};
/// A cube on a light one of 1 kg per cubic decimetre, `offset` (edges) aside and `gap` (edges) above it, for a second.
inline Stood stand_on_light_cube(Lab lab, double edge, double ratio, double offset, double gap) {
  const PartModelPtr cube = box(Vec3::Constant(edge));
  const double mass = 1000.0 * edge * edge * edge;
  const auto light = lab.place(cube, Vec3(0, 0, 0.5 * edge), Quat::Identity(), material(0.5, 0.0, mass));
  const auto heavy =
      lab.place(cube, Vec3(offset, 0, 1.5 + gap) * edge, Quat::Identity(), material(0.5, 0.0, ratio * mass));
  lab.begin(phases::hold);
  Stood out;
  while (lab.time() < 1.0) {
    lab.simulate(lab.solver().step_size());
    out.moved = std::max(out.moved, lab.center(light).head<2>().norm() / edge);
    if (const auto worst = lab.solver().take_worst_contact(lab.world()))
      out.deepest = std::max(out.deepest, worst->relative);
  }
  const std::vector<bool> asleep = lab.solver().asleep(lab.world());
  out.rests = asleep[light] && asleep[heavy];
  return out;
}

/// Cubes that fall on each other one after the other, without friction.
inline Rebound pile_up_cubes(Lab lab, int count) {
  const double edge = 0.05;
  lab.def().bin.friction = 0.0;
  const PartModelPtr cube = box(Vec3::Constant(edge));
  for (int i = 0; i < count; ++i)
    lab.place(cube, Vec3(0, 0, (0.5 + i) * edge + 0.3 * i), Quat::Identity(), material(0.0));
  Rebound out{0.0, 0.0, 1.0};
  while (lab.time() < 1.0) {
    lab.simulate(lab.solver().step_size());
    for (int i = 0; i < count; ++i) {
      const BodyState state = lab.state(static_cast<std::size_t>(i));
      out.speed = std::max(out.speed, state.velocity.linear.z());
      out.aside = std::max(out.aside, state.pose.position.head<2>().norm() / edge);
      if (i > 0)
        out.height = std::min(
            out.height, (state.pose.position - lab.state(static_cast<std::size_t>(i - 1)).pose.position).z() / edge);
    }
  }
  return out;
}

/// A body that slides over a row of boxes whose tops are level, from seam to seam.
struct TileRide {
  double edge;          ///< of a box, m
  double turn;          ///< of what slides, about z, rad
  double friction;      ///< of what slides and of the boxes
  bool on_floor;        ///< the boxes are free and of 10 times the mass, and lie on the floor
  PartModelPtr slider;  ///< what slides, on a flat face
  double gap = 1e-6;    ///< between the boxes / edge
};
struct Ridden {
  double change = 0.0;    ///< largest change of the velocity / speed
  double distance = 0.0;  ///< until it stops, or until the end / that of a body on a plane, v^2 / (2 mu g)
  double lifted = 0.0;    ///< highest that it went / edge
};
/// Without friction, it goes at three times sqrt(g edge) over eight seams, and nothing stops it. With friction, it
/// comes to rest.
inline Ridden ride_over_tiles(Lab lab, const TileRide& ride) {
  const double edge = ride.edge, top = ride.on_floor ? edge : 0.0, speed = 3.0 * std::sqrt(g * edge);
  lab.def().bin.kind = ride.on_floor ? Bin::Kind::floor : Bin::Kind::none;
  lab.def().bin.friction = 1.0;
  const PartModelPtr& slider = ride.slider;
  double low = 0.0;
  for (const Vec3& vertex : slider->mesh().vertices) low = std::min(low, vertex.z() - slider->mass().center.z());
  const double mass = 1000.0 * slider->mass().volume;
  const Vec3 start(0, 0, top - low);
  const auto body =
      lab.place(slider, start, Quat(Eigen::AngleAxisd(ride.turn, Vec3::UnitZ())), material(ride.friction, 0.0, mass));
  BodyDef tile = material(ride.friction, 0.0, 10.0 * mass);
  tile.fixed = !ride.on_floor;
  const PartModelPtr square = box(Vec3((1.0 - ride.gap) * edge, 6.0 * edge, edge));
  for (int i = -2; i < 12; ++i) lab.place(square, Vec3(i * edge, 0, top - 0.5 * edge), Quat::Identity(), tile);
  const Vec3 velocity(speed, 0, 0);
  lab.start(body).velocity.linear = velocity;
  lab.begin(phases::pour);
  const double plane = ride.friction > 0.0 ? 0.5 * speed * speed / (ride.friction * g) : 8.0 * edge;
  const double longest = ride.friction > 0.0 ? 1.5 * speed / (ride.friction * g) : 1.02 * plane / speed;
  Ridden out;
  while (lab.time() < longest && (ride.friction > 0.0 || lab.center(body).x() < plane)) {
    lab.simulate(lab.solver().step_size());
    out.change = std::max(out.change, (lab.state(body).velocity.linear - velocity).norm() / speed);
    out.lifted = std::max(out.lifted, (lab.center(body) - start).z() / edge);
  }
  out.distance = lab.center(body).x() / plane;
  return out;
}

/// A house of cards.
struct CardHouse {
  static constexpr double length = 0.09, width = 0.06, thickness = 0.001, friction = 0.5;
  int levels = 3;
  double lean = 0.42;  ///< rad off the upright, of its leaning cards
  double gap = 0.0;    ///< m: cards begin so far from each other, or twice as far
  double up = 0.5 * (length * std::cos(lean) + thickness * std::sin(lean));         // half a leaning card's height
  double out = 0.5 * (length * std::sin(lean) + thickness * std::cos(lean)) + gap;  // and half of its reach
  double pitch = 4.0 * out, level_height = 2.0 * up + thickness + 2.0 * gap;
  double height() const { return levels * level_height; }

  /// Its cards are the next bodies, each of `mass` (kg); returns where their centres are.
  std::vector<Vec3> place(Lab& lab, double mass = 1.0) const {
    const PartModelPtr card = box({thickness, width, length}), roof = box({0.98 * pitch, width, thickness});
    lab.def().bin.friction = friction;
    std::vector<Vec3> starts;
    const auto put = [&](const PartModelPtr& part, const Vec3& at, double turn) {
      lab.place(part, at, Quat(Eigen::AngleAxisd(turn, Vec3::UnitY())), material(friction, 0.0, mass));
      starts.push_back(at);
    };
    for (int level = 0; level < levels; ++level) {
      const int pairs = levels - level;
      const double base = level * level_height, first = -0.5 * (pairs - 1) * pitch;
      for (int i = 0; i < pairs; ++i)
        for (const double side : {-1.0, 1.0})
          put(card, Vec3(first + i * pitch + side * out, 0, base + up + gap), -side * lean);
      for (int i = 0; i + 1 < pairs; ++i)
        put(roof, Vec3(first + (i + 0.5) * pitch, 0, base + 2.0 * (up + gap) + 0.5 * thickness), 0.0);
    }
    return starts;
  }
};

/// Farthest that a card of a house that stands moves in six seconds / its length.
inline double card_house_drift(Lab lab, Phase phase, const CardHouse& house = {}, double seconds = 6.0) {
  const std::vector<Vec3> starts = house.place(lab);
  lab.begin(phase);
  lab.simulate(seconds);
  double most = 0.0;
  for (std::size_t b = 0; b < starts.size(); ++b)
    most = std::max(most, (lab.center(b) - starts[b]).norm() / CardHouse::length);
  return most;
}

}  // namespace bin_scenes::testing
