/// Contacts between parts that press each other apart: wedges, spikes, taut chains, cards under blocks. As numbers,
/// like closed_form_scenes.hpp.
#pragma once

#include "solver/hard_contact_scenes.hpp"
#include "solver/tight_scenes.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes::testing {

/// A prism along y that stands on its edge at z = 0, its upper face at `height`.
inline Mesh wedge_mesh(double half, double height, double length) {
  Mesh mesh;
  for (const double y : {-0.5 * length, 0.5 * length})
    for (const Vec3& v : {Vec3(0, y, 0), Vec3(half, y, height), Vec3(-half, y, height)}) mesh.vertices.push_back(v);
  mesh.triangles = {{0, 1, 2}, {3, 5, 4}, {0, 3, 4}, {0, 4, 1}, {1, 4, 5}, {1, 5, 2}, {2, 5, 3}, {2, 3, 0}};
  return mesh;
}

enum class Point { wedge, spike };
/// A part of `size` (m) that ends in an edge or a tip at 0, `slim` times as wide to either side.
inline PartModelPtr pointed(Point point, double size, double slim) {
  const double half = slim * size;
  return PartModel::from_mesh(
      point == Point::wedge ? wedge_mesh(half, size, 2.0 * half) : spike_mesh(4, std::sqrt(2.0) * half, size, M_PI / 4),
      "pointed");
}

struct Pressed {
  double risen;  ///< EnergyRise, of one part
  double hop;    ///< farthest that one comes up / d
};
struct Row {
  Point point = Point::wedge;
  double size = 0.05, slim = 0.3;
  double friction = 0.0;
  double gap = 0.0;     ///< / size
  double load = 0.0;    ///< kg of a block that lies across; a part has 1 kg
  bool stands = false;  ///< those below are fixed; else they are pushed apart
};
/// Three parts with their tips up, side by side, and two upside down between them.
inline Pressed press_between(Lab lab, const Row& row) {
  const double half = row.slim * row.size, up = row.gap * row.size * std::hypot(1.0, row.slim) / row.slim;
  lab.def().bin.friction = row.friction;
  const PartModelPtr part = pointed(row.point, row.size, row.slim);
  const Quat turned(Eigen::AngleAxisd(M_PI, Vec3::UnitX()));
  for (int i = -1; i <= 1; ++i) {
    BodyDef body = material(row.friction);
    body.fixed = row.stands;
    lab.place(part, Vec3(2.0 * half * i, 0, row.size) + turned * part->mass().center, turned, body);
  }
  std::vector<std::size_t> between;
  for (const double side : {-1.0, 1.0})
    between.push_back(
        lab.place(part, Vec3(side * half, 0, up) + part->mass().center, Quat::Identity(), material(row.friction)));
  if (row.load > 0.0)
    lab.place(box({4.0 * half, 2.0 * half, 0.1 * row.size}), Vec3(0, 0, 1.05 * row.size + up), Quat::Identity(),
              material(row.friction, 0.0, row.load));
  EnergyRise rise(lab, between.size() + 3 + (row.load > 0.0), g * part->diagonal());
  lab.begin(phases::pour);
  Pressed out{0.0, 0.0};
  const double start = lab.center(between[0]).z();
  for (; lab.time() < 0.3; lab.simulate(lab.solver().step_size())) {
    rise.look();
    for (const std::size_t b : between) out.hop = std::max(out.hop, (lab.center(b).z() - start) / part->diagonal());
  }
  out.risen = rise.most();
  return out;
}

/// Two spikes of `size` (m), one upright on the floor, the other upside down above it, its tip `aside` (/ size) of the
/// tip below and `drop` (/ size) above it.
struct Tips {
  std::uint32_t sides;
  double size, slim, aside, drop;
};
/// The upper one slides off and falls: EnergyRise of both.
inline double tip_on_tip(Lab lab, const Tips& tips) {
  constexpr double friction = 0.5;
  lab.def().bin.friction = friction;
  const PartModelPtr part = PartModel::from_mesh(
      spike_mesh(tips.sides, std::sqrt(2.0) * tips.slim * tips.size, tips.size, M_PI / tips.sides), "spike");
  const Quat upright(Eigen::AngleAxisd(M_PI, Vec3::UnitX())), turned(Eigen::AngleAxisd(0.1, Vec3::UnitZ()));
  lab.place(part, Vec3(0, 0, tips.size) + upright * part->mass().center, upright, material(friction));
  const Vec3 tip = tips.size * Vec3(tips.aside, 0.37 * tips.aside, 1.0 + tips.drop);
  lab.place(part, tip + turned * part->mass().center, turned, material(friction));
  EnergyRise rise(lab, 2, g * part->diagonal());
  lab.begin(phases::pour);
  const double end = std::sqrt(tips.size / 0.5);
  for (; lab.time() < end; lab.simulate(lab.solver().step_size())) rise.look();
  return rise.most();
}

/// A wedge falls with its edge first from `height` (edges of the cubes) between two cubes of a quarter of its mass,
/// which stand 0.2 % of an edge apart: how much farther one cube is pushed than the other / edge, at any time.
inline double uneven_split(Lab lab, double edge, double height) {
  lab.def().bin.friction = 0.01;
  const PartModelPtr wedge = PartModel::from_mesh(wedge_mesh(0.4 * edge, edge, 0.8 * edge), "wedge");
  const PartModelPtr cube = box(Vec3::Constant(edge));
  lab.place(wedge, Vec3(0, 0, height * edge) + wedge->mass().center, Quat::Identity(), material(0.01, 0.0, 4.0));
  std::array<std::size_t, 2> cubes;
  for (const int side : {0, 1})
    cubes[side] =
        lab.place(cube, Vec3(side == 0 ? -0.501 : 0.501, 0, 0.5) * edge, Quat::Identity(), material(0.01, 0.0, 1.0));
  double most = 0.0;
  while (lab.time() < 1.1 * std::sqrt(edge / g)) {
    lab.simulate(lab.solver().step_size());
    most = std::max(most, std::abs(lab.center(cubes[0]).x() + lab.center(cubes[1]).x()) / edge);
  }
  return most;
}

/// What each side of a groove presses with on a frictionless wedge of weight W in it / W: 1 / (2 sin of half its
/// angle).
inline double pressed_in_groove(Lab lab, double slim) {
  const double size = 0.05;
  lab.def().bin.kind = Bin::Kind::none;
  const Quat turned(Eigen::AngleAxisd(M_PI, Vec3::UnitX()));
  const PartModelPtr part = pointed(Point::wedge, size, slim);
  BodyDef stands = material(0.0);
  stands.fixed = true;
  for (const double side : {-1.0, 1.0})
    lab.place(part, Vec3(side * slim * size, 0, size) + turned * part->mass().center, turned, stands);
  const auto between = lab.place(part, part->mass().center, Quat::Identity(), material(0.0));
  lab.begin(phases::press);
  lab.simulate(0.5);
  return lab.wrench(between, 0).force.norm() / g;
}

struct Slid {
  double lost;  ///< energy / of that at the start, seen from the rim
  double spin;  ///< rad/s: the face turned what slid on its tip
};
/// A spike slides without friction down the face of a fixed wedge, tip first, over its rim, and falls on.
inline Slid slide_over_rim(Lab lab, double size) {
  const double half = 0.6 * size;
  lab.def().bin.kind = Bin::Kind::none;
  const PartModelPtr wedge = PartModel::from_mesh(wedge_mesh(half, size, 2.0 * size), "wedge");
  const Quat turned(Eigen::AngleAxisd(M_PI, Vec3::UnitX()));
  const PartModelPtr spike = pointed(Point::spike, size, 0.2);
  const Vec3 down = Vec3(half, 0, -size).normalized(), out = Vec3(size, 0, half).normalized();
  const Vec3 tip = 0.4 * std::hypot(half, size) * down + 1e-4 * size * out + Vec3(0, 0, size);  // the ridge is up there
  const Quat pose(Eigen::AngleAxisd(0.9, Vec3::UnitY()));
  const auto body = lab.place(spike, tip + pose * spike->mass().center, pose, material(0.0));
  lab.start(body).velocity.linear = std::sqrt(2.0 * g * size) * down;
  place_fixed(lab, wedge, 0.0);
  lab.start(1).pose = {Vec3(0, 0, size), turned};
  const auto now = [&] { return lab.kinetic_energy(body) + g * lab.center(body).z(); };
  lab.begin(phases::pour);
  const double before = now();
  while (lab.center(body).z() > -size && lab.time() < 1.0) lab.simulate(lab.solver().step_size());
  return {(before - now()) / before, lab.state(body).velocity.angular.norm()};
}

/// A chain of links that hangs from its first and was lifted along a line, `slack` of their length apart: largest gain
/// of energy / of what it had lost by then.
inline double given_back_by_a_chain(Lab lab, int count, double slack) {
  const double inner = 0.03;
  lab.def().bin.kind = Bin::Kind::none;
  const PartModelPtr link = PartModel::from_mesh(ring_mesh(12, inner, 0.04, 0.01), "link");
  for (int i = 0; i < count; ++i) {
    BodyDef body = material(0.5);
    body.fixed = i == 0;
    lab.place(link, Vec3(i * slack * 2.0 * inner, 0, 1.0), Quat(Eigen::AngleAxisd(i % 2 * M_PI / 2.0, Vec3::UnitX())),
              body);
  }
  const auto bodies = static_cast<std::size_t>(count);
  lab.begin(phases::pour);
  const double start = energy(lab, bodies);
  double least = start, most = 0.0;
  for (; lab.time() < 1.5; lab.simulate(lab.solver().step_size())) {
    const double now = energy(lab, bodies);
    least = std::min(least, now);
    most = std::max(most, now - least);
  }
  return most / (start - least);
}

/// Four blocks (`aside`: m) of 500 times a card's mass fall on a house of cards: fastest of all that moves / what a
/// leaning card does that the fastest block squeezes out, as a ladder that slips.
inline double blocks_on_cards(Lab lab, double aside) {
  const CardHouse house;
  house.place(lab, 0.002);
  const std::size_t cards = lab.def().bodies.size();
  const double edge = 0.05;
  for (int i = 0; i < 4; ++i)
    lab.place(box(Vec3::Constant(edge)), Vec3(aside - 0.06 + 0.04 * i, 0.005 * i, house.height() + 0.1 + 0.08 * i),
              Quat(Eigen::AngleAxisd(0.2 * i, Vec3::UnitY())), material(0.5));
  lab.begin(phases::pour);
  double block = 0.0, fastest = 0.0;
  while (lab.time() < 1.0) {
    lab.simulate(lab.solver().step_size());
    const std::vector<BodyState> states = lab.states();
    for (std::size_t b = 0; b < states.size(); ++b) {
      const double speed = states[b].velocity.linear.norm();
      (b < cards ? fastest : block) = std::max(b < cards ? fastest : block, speed);
    }
  }
  return std::max(fastest, block) / (block / std::tan(house.lean));
}

}  // namespace bin_scenes::testing
