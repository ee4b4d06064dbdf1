/// Parts that fit into each other with little room: corners, pegs, spikes, threads, links. As numbers, like
/// closed_form_scenes.hpp.
#pragma once

#include "solver/closed_form_scenes.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes::testing {

/// Energy of what moves, kinetic and of height, J.
inline double energy(const Lab& lab, std::size_t bodies) {
  double sum = 0.0;
  const std::vector<BodyState> states = lab.states();
  for (std::size_t b = 0; b < bodies; ++b)
    if (!lab.body(b).fixed)
      sum += lab.kinetic_energy(b, states[b]) + lab.body(b).mass * g * (states[b].pose * lab.part(b).mass().center).z();
  return sum;
}

/// Nothing but contacts gives energy: how far it rose above the least before / m g d of the smallest part.
class EnergyRise {
 public:
  EnergyRise(const Lab& lab, std::size_t bodies, double scale) : lab_(lab), bodies_(bodies), scale_(scale) {}
  void look() {
    const double now = energy(lab_, bodies_);
    least_ = std::min(least_, now);
    most_ = std::max(most_, (now - least_) / scale_);
  }
  double most() const { return most_; }

 private:
  const Lab& lab_;
  std::size_t bodies_;
  double scale_, least_ = 1e300, most_ = 0.0;
};

/// A block from z = -below to 0 with an opening in its top: `rim` (counter-clockwise seen from above, around the z
/// axis, at z = 0) leads down to `bottom` of as many points, or to one point; open below if `through`.
inline Mesh block_with_hole(double half, double below, const std::vector<Vec3>& rim, const std::vector<Vec3>& bottom,
                            bool through = false) {
  Mesh mesh;
  const auto n = static_cast<std::uint32_t>(rim.size());
  const auto add = [&](const std::vector<Vec3>& points) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), points.begin(), points.end());
    return first;
  };
  const auto square = [&](double z) {
    return std::vector<Vec3>{{-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z}};
  };
  const std::uint32_t top = add(square(0.0)), base = add(square(-below)), edge = add(rim), deep = add(bottom);
  // Between the square and a polygon, both counter-clockwise around the axis: the side whose triangle leans less.
  const auto ring = [&](std::uint32_t outer, std::uint32_t inner, bool up) {
    const auto lean = [&](std::uint32_t a, std::uint32_t b) {
      const Vec3 &p = mesh.vertices[a], &q = mesh.vertices[b];
      return std::abs(std::remainder(std::atan2(p.y(), p.x()) - std::atan2(q.y(), q.x()), 2.0 * M_PI));
    };
    std::uint32_t start = 0, i = 0, k = 0;
    for (std::uint32_t s = 1; s < n; ++s)
      if (lean(outer, inner + s) < lean(outer, inner + start)) start = s;
    while (i < 4 || k < n) {
      const std::uint32_t o = outer + i % 4, next_o = outer + (i + 1) % 4, p = inner + (start + k) % n,
                          next_p = inner + (start + k + 1) % n;
      const bool outward = k == n || (i < 4 && lean(next_o, p) <= lean(next_p, o));
      Triangle t = outward ? Triangle{o, next_o, p} : Triangle{o, next_p, p};
      ++(outward ? i : k);
      if (!up) std::swap(t[0], t[1]);
      mesh.triangles.push_back(t);
    }
  };
  ring(top, edge, true);
  for (std::uint32_t i = 0; i < 4; ++i) {
    const std::uint32_t next = (i + 1) % 4;
    mesh.triangles.insert(mesh.triangles.end(), {{base + i, base + next, top + next}, {base + i, top + next, top + i}});
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t next = (i + 1) % n;
    if (bottom.size() == 1) {
      mesh.triangles.push_back({edge + i, edge + next, deep});
      continue;
    }
    mesh.triangles.insert(mesh.triangles.end(),
                          {{edge + i, edge + next, deep + i}, {edge + next, deep + next, deep + i}});
    if (!through && i > 1) mesh.triangles.push_back({deep, deep + i - 1, deep + i});
  }
  if (through)
    ring(base, deep, false);
  else
    mesh.triangles.insert(mesh.triangles.end(), {{base, base + 2, base + 1}, {base, base + 3, base + 2}});
  return mesh;
}

/// `sides` points around the z axis, one of them at `angle`.
inline std::vector<Vec3> polygon(std::uint32_t sides, double radius, double z, double angle = 0.0) {
  std::vector<Vec3> points;
  for (std::uint32_t k = 0; k < sides; ++k) {
    const double a = angle + 2.0 * M_PI * k / sides;
    points.emplace_back(radius * std::cos(a), radius * std::sin(a), z);
  }
  return points;
}

/// A cone of `sides` faces that stands on its point at 0, its base at `height`.
inline Mesh spike_mesh(std::uint32_t sides, double radius, double height, double angle = 0.0) {
  Mesh mesh;
  mesh.vertices = polygon(sides, radius, height, angle);
  mesh.vertices.emplace_back(0, 0, 0);
  for (std::uint32_t k = 0; k < sides; ++k) {
    mesh.triangles.push_back({k, sides, (k + 1) % sides});
    if (k > 1) mesh.triangles.push_back({0, k - 1, k});
  }
  return mesh;
}

struct Fit {
  Vec3 off;       ///< from where it should come to lie / d
  double turned;  ///< rad
  double risen;   ///< EnergyRise
};
/// Body 0 falls onto the fixed body 1. `rest`: where its centre of mass should come to lie.
inline Fit fit(Lab& lab, const Vec3& rest, double seconds) {
  const double d = lab.part(0).diagonal();
  EnergyRise rise(lab, 1, g * d);
  lab.begin(phases::pour);
  for (; lab.time() < seconds; lab.simulate(lab.solver().step_size())) rise.look();
  rise.look();
  return {(lab.center(0) - rest) / d, lab.state(0).pose.orientation.angularDistance(lab.start(0).pose.orientation),
          rise.most()};
}

inline void place_fixed(Lab& lab, const PartModelPtr& part, double friction) {
  BodyDef body = material(friction);
  body.fixed = true;
  lab.place(part, part->mass().center, Quat::Identity(), body);
}

/// A corner of three faces above the pit of its form, `gap` (m) from each face when it is let go from `drop` (m)
/// higher.
inline Fit corner_into_pit(Lab lab, double gap, double drop, double friction) {
  const std::uint32_t sides = 3;
  const double radius = 0.6, height = 0.8, depth = 0.6, angle = 0.3;
  const double slope = std::sin(std::atan2(radius * std::cos(M_PI / sides), height));  // gap / distance down
  lab.def().bin.kind = Bin::Kind::none;
  const PartModelPtr corner = PartModel::from_mesh(spike_mesh(sides, radius, height, angle), "corner");
  const Vec3 rest = Vec3(0, 0, -depth) + corner->mass().center;
  lab.place(corner, rest + Vec3(0, 0, gap / slope + drop), Quat::Identity(), material(friction));
  const std::vector<Vec3> rim = polygon(sides, radius * depth / height, 0.0, angle);
  place_fixed(lab, PartModel::from_mesh(block_with_hole(1.0, 1.0, rim, {Vec3(0, 0, -depth)}), "pit"), friction);
  return fit(lab, rest, 2.0);
}

/// A peg of `sides`, 20 mm wide, over a hole of 40 mm that is wider by `play` (of its width), 5 mm above its mouth.
inline Fit peg_into_hole(Lab lab, std::uint32_t sides, double play, double friction) {
  const double width = 0.02, radius = 0.5 * width / std::cos(M_PI / sides), depth = 2.0 * width, wide = 1.0 + play;
  const double angle = M_PI / 4.0;
  lab.def().bin.kind = Bin::Kind::none;
  Mesh mesh = prism_mesh(sides, radius, 0.0, 2.5 * width);
  for (Vec3& v : mesh.vertices) v = Eigen::AngleAxisd(angle, Vec3::UnitZ()) * v;
  const PartModelPtr peg = PartModel::from_mesh(mesh, "peg");
  lab.place(peg, peg->mass().center + Vec3(0, 0, 0.005), Quat::Identity(), material(friction));
  const Mesh hole = block_with_hole(1.5 * width, 1.2 * depth, polygon(sides, wide * radius, 0.0, angle),
                                    polygon(sides, wide * radius, -depth, angle));
  place_fixed(lab, PartModel::from_mesh(hole, "hole"), friction);
  return fit(lab, Vec3(0, 0, -depth) + peg->mass().center, 1.0);
}

/// A spike that falls into a hole narrower than it, tilted and aside, and rattles on its mouth: EnergyRise.
inline double spike_into_hole(Lab lab, double turn, double tilt, double aside, double drop, double friction) {
  lab.def().bin.kind = Bin::Kind::none;
  const PartModelPtr spike = PartModel::from_mesh(spike_mesh(4, 0.2, 1.0, M_PI / 4.0), "spike");
  const Quat pose =
      Quat(Eigen::AngleAxisd(tilt, Vec3(1, 0.3, 0).normalized())) * Quat(Eigen::AngleAxisd(turn, Vec3::UnitZ()));
  lab.place(spike, Vec3(aside, 0.5 * aside, drop) + pose * spike->mass().center, pose, material(friction));
  const Mesh hole = block_with_hole(0.5, 0.6, polygon(4, 0.1, 0.0, M_PI / 4.0), polygon(4, 0.1, -0.5, M_PI / 4.0));
  place_fixed(lab, PartModel::from_mesh(hole, "hole"), friction);
  return fit(lab, Vec3::Zero(), 2.0).risen;
}

/// A bolt of a helical thread (10 mm radius, 3 mm pitch, depth 1.2 mm) in a fixed nut wider by `play` (m), without
/// friction, three turns deep in it: distance down in `seconds` (m), and EnergyRise.
struct Screw {
  double distance, risen;
};
inline Screw screw_down(Lab lab, double play, double seconds, std::uint32_t turns = 8) {
  constexpr std::uint32_t around = 48, per_turn = 8;
  constexpr double radius = 0.01, depth = 0.0012, pitch = 0.003;
  const auto thread = [&](std::uint32_t turns, double outer, bool is_nut) {
    Mesh mesh;
    const std::uint32_t rows = turns * per_turn + 1;
    const auto at = [&](std::uint32_t row, std::uint32_t k) { return row * around + k % around; };
    const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
      mesh.triangles.insert(mesh.triangles.end(), {{a, b, c}, {a, c, d}});
    };
    for (std::uint32_t row = 0; row < rows; ++row)
      for (std::uint32_t k = 0; k < around; ++k) {
        const double height = static_cast<double>(row) / per_turn, angle = 2.0 * M_PI * k / around;
        const double phase = height - static_cast<double>(k) / around;
        const double r = outer - depth * std::abs(2.0 * (phase - std::floor(phase)) - 1.0);
        mesh.vertices.emplace_back(r * std::cos(angle), r * std::sin(angle), pitch * height);
      }
    const auto beyond = static_cast<std::uint32_t>(mesh.vertices.size());  // the outside of a nut, or middles of ends
    for (const double z : {0.0, pitch * turns})
      if (is_nut)
        for (const Vec3& v : polygon(around, 1.7 * radius, z)) mesh.vertices.push_back(v);
      else
        mesh.vertices.emplace_back(0, 0, z);
    for (std::uint32_t k = 0; k < around; ++k) {
      const std::uint32_t top = rows - 1, next = k + 1;
      for (std::uint32_t row = 0; row < top; ++row)
        if (is_nut)
          quad(at(row, next), at(row, k), at(row + 1, k), at(row + 1, next));
        else
          quad(at(row, k), at(row, next), at(row + 1, next), at(row + 1, k));
      const std::uint32_t low = beyond + k, low_next = beyond + next % around;
      if (is_nut) {
        quad(low, low_next, low_next + around, low + around);
        quad(low, at(0, k), at(0, next), low_next);
        quad(low_next + around, at(top, next), at(top, k), low + around);
      } else {
        mesh.triangles.insert(mesh.triangles.end(),
                              {{beyond, at(0, next), at(0, k)}, {beyond + 1, at(top, k), at(top, next)}});
      }
    }
    return mesh;
  };
  lab.def().bin.kind = Bin::Kind::none;
  const PartModelPtr bolt = PartModel::from_mesh(thread(turns, radius, false), "bolt");
  const Vec3 start = Vec3(0, 0, 3.0 * pitch) + bolt->mass().center;
  lab.place(bolt, start, Quat::Identity(), material(0.0));
  place_fixed(lab, PartModel::from_mesh(thread(4, radius + play, true), "nut"), 0.0);
  const Fit end = fit(lab, start, seconds);
  return {-end.off.z() * bolt->diagonal(), end.risen};
}

struct Chain {
  double risen;  ///< EnergyRise, of one link
  double apart;  ///< largest distance of neighbours' centres / that at which they hold each other
};
/// `count` links between two that are fixed, `slack` of their length apart at first.
inline Chain hang_chain(Lab lab, int count, double slack) {
  const double inner = 0.03, outer = 0.04;
  lab.def().bin.kind = Bin::Kind::none;
  const PartModelPtr link = PartModel::from_mesh(ring_mesh(12, inner, outer, 0.01), "link");
  for (int i = 0; i < count; ++i) {
    BodyDef body = material(0.5);
    body.fixed = i == 0 || i == count - 1;
    lab.place(link, Vec3(i * slack * 2.0 * inner, 0, 1.0), Quat(Eigen::AngleAxisd(i % 2 * M_PI / 2.0, Vec3::UnitX())),
              body);
  }
  const auto bodies = static_cast<std::size_t>(count);
  EnergyRise rise(lab, bodies, g * link->diagonal());
  lab.begin(phases::pour);
  Chain out{0.0, 0.0};
  while (lab.time() < 4.0) {
    rise.look();
    lab.simulate(lab.solver().step_size());
    for (std::size_t i = 1; i < bodies; ++i)
      out.apart = std::max(out.apart, (lab.center(i) - lab.center(i - 1)).norm() / (2.0 * inner));
  }
  out.risen = rise.most();
  return out;
}

constexpr double sheet_thickness = 2e-4;  ///< m

struct Sheets {
  double lower, upper;  ///< of their middles, off where they lie at rest / thickness
};
/// A sheet of 1/5 mm that falls across another.
inline Sheets falling_sheet(Lab lab) {
  const PartModelPtr sheet = box({0.05, 0.04, sheet_thickness});
  lab.place(sheet, Vec3(0, 0, 0.5 * sheet_thickness));
  lab.place(sheet, Vec3(0, 0, 0.02), Quat(Eigen::AngleAxisd(0.5 * M_PI, Vec3::UnitZ())));
  lab.simulate(0.5);
  const auto off = [&](std::size_t i) { return std::abs(lab.center(i).z() / sheet_thickness - (i + 0.5)); };
  return {off(0), off(1)};
}

/// Two sheets under a block of a hundred times their mass: how far the upper one sinks / thickness.
inline double loaded_sheets(Lab lab) {
  const PartModelPtr sheet = box({0.05, 0.04, sheet_thickness});
  for (const double place : {0.5, 1.5})
    lab.place(sheet, Vec3(0, 0, place * sheet_thickness), Quat::Identity(), material(0.5, 0.0, 0.01));
  lab.place(box(Vec3::Constant(0.04)), Vec3(0, 0, 2.0 * sheet_thickness + 0.02), Quat::Identity(), material(0.5));
  lab.simulate(0.5);
  return std::abs(lab.center(1).z() / sheet_thickness - 1.5);
}

}  // namespace bin_scenes::testing
