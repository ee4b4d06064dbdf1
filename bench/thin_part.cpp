#include "thin_part.hpp"

#include "piece_files.hpp"

#include "bin_scenes/core/error.hpp"

#include <cmath>
#include <functional>
#include <map>

namespace bin_scenes::bench {

namespace {

using Prisms = std::vector<Prism>;

Prism box(const Vec3& center, const Vec3& size) {
  Prism prism;
  for (const double z : {-0.5, 0.5})
    for (const auto& [x, y] : {std::pair(-0.5, -0.5), {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}})
      prism.push_back(center + Vec3(x, y, z).cwiseProduct(size));
  return prism;
}

Vec3 on_circle(double radius, double turns, double z) {
  return {radius * std::cos(2 * M_PI * turns), radius * std::sin(2 * M_PI * turns), z};
}

/// A wire from p to q, longer by half its radius at either end, so that those of a path overlap.
Prism wire(const Vec3& p, const Vec3& q, double radius) {
  constexpr int sides = 8;
  const Vec3 along = (q - p).normalized(), u = along.unitOrthogonal(), v = along.cross(u);
  Prism prism;
  for (const Vec3& end : {Vec3(p - 0.5 * radius * along), Vec3(q + 0.5 * radius * along)})
    for (int i = 0; i < sides; ++i) {
      const Vec3 around = on_circle(radius, (i + 0.5) / sides, 0);
      prism.push_back(end + around.x() * u + around.y() * v);
    }
  return prism;
}

Prisms sheet() {
  return {box(Vec3::Zero(), {50, 30, 0.5})};
}

Prisms disc() {
  Prism prism;
  for (const double z : {0.0, 0.6})
    for (int i = 0; i < 24; ++i) prism.push_back(on_circle(25, i / 24.0, z));
  return {prism};
}

Prisms lattice() {
  Prisms bars;
  for (int i = -2; i <= 2; ++i) {
    bars.push_back(box({10.0 * i, 0, 0}, {2, 42, 2}));
    bars.push_back(box({0, 10.0 * i, 0}, {42, 2, 2}));
  }
  return bars;
}

Prisms comb() {
  Prisms teeth = {box(Vec3::Zero(), {50, 6, 3})};
  for (int i = -4; i <= 4; ++i) teeth.push_back(box({5.5 * i, 12, 0}, {2, 22, 3}));
  return teeth;
}

Prisms frame() {
  Prisms bars;
  for (const int side : {-1, 1}) {
    bars.push_back(box({0, 18.0 * side, 0}, {50, 4, 3}));
    bars.push_back(box({23.0 * side, 0, 0}, {4, 40, 3}));
  }
  return bars;
}

Prisms tube() {
  constexpr int sectors = 16;
  Prisms wall;
  for (int i = 0; i < sectors; ++i) {
    const double from = static_cast<double>(i) / sectors, to = static_cast<double>(i + 1) / sectors;
    Prism sector;
    for (const double z : {0.0, 45.0})
      for (const Vec3& corner :
           {on_circle(11, from, z), on_circle(13, from, z), on_circle(13, to, z), on_circle(11, to, z)})
        sector.push_back(corner);
    wall.push_back(sector);
  }
  return wall;
}

Prisms wire_ring() {
  constexpr int pieces = 16;
  Prisms ring;
  for (int i = 0; i < pieces; ++i)
    ring.push_back(wire(on_circle(22, i / 16.0, 0), on_circle(22, (i + 1) / 16.0, 0), 1.2));
  return ring;
}

Prisms spring() {
  constexpr int pieces = 44, of_a_turn = 10;
  constexpr double pitch = 7.0;
  const auto at = [](int i) {
    const double turns = static_cast<double>(i) / of_a_turn;
    return on_circle(10, turns, pitch * turns);
  };
  Prisms coil;
  for (int i = 0; i < pieces; ++i) coil.push_back(wire(at(i), at(i + 1), 1.3));
  return coil;
}

const std::map<std::string, std::function<Prisms()>>& makers() {
  static const std::map<std::string, std::function<Prisms()>> all = {
      {"sheet", sheet}, {"disc", disc}, {"lattice", lattice},     {"comb", comb},
      {"frame", frame}, {"tube", tube}, {"wire_ring", wire_ring}, {"spring", spring}};
  return all;
}

}  // namespace

const std::vector<std::string>& thin_parts() {
  static const std::vector<std::string> names = {"sheet", "disc", "lattice",   "comb",
                                                 "frame", "tube", "wire_ring", "spring"};
  return names;
}

int write_thin_part(const std::string& folder, const std::string& name) {
  const auto maker = makers().find(name);
  if (maker == makers().end()) throw input_error("no thin part of this name", name, "see bench/thin_part.hpp");
  const Prisms prisms = maker->second();
  write_pieces(folder, prisms);
  return static_cast<int>(prisms.size());
}

}  // namespace bin_scenes::bench
