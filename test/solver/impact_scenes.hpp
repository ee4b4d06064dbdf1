/// Impacts between meshes, held against closed forms. As numbers, like closed_form_scenes.hpp.
#pragma once

#include "bin_scenes/core/random.hpp"
#include "solver/closed_form_scenes.hpp"

#include <algorithm>
#include <string>

namespace bin_scenes::testing {

/// Three boxes of random size and turn about a common middle, 50 mm from corner to corner of the bounding box.
inline PartModelPtr three_boxes(std::uint64_t seed) {
  Random random(seed, 0, Stream::probe);
  Mesh mesh;
  for (int i = 0; i < 3; ++i) {
    Mesh piece = box_mesh({random.uniform(0.5, 1.0), random.uniform(0.15, 0.4), random.uniform(0.15, 0.4)});
    const Quat turn = random.orientation();
    const Vec3 off = 0.15 * Vec3(random.normal(), random.normal(), random.normal());
    for (Vec3& v : piece.vertices) v = turn * v + off;
    mesh = merged(mesh, piece);
  }
  Vec3 low = mesh.vertices[0], high = low;
  for (const Vec3& v : mesh.vertices) {
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  for (Vec3& v : mesh.vertices) v *= 0.05 / (high - low).norm();
  return PartModel::from_mesh(mesh, "three_boxes_" + std::to_string(seed));
}

struct Impact {
  double aside;            ///< fastest along the surface / speed of the impact
  double gain;             ///< highest energy / that at the start - 1
  std::vector<Vec3> path;  ///< of the centre, every 0.01 s
};

/// A part falls from `height` (m, of its lowest point) without friction and restitution, and goes on for `seconds`.
inline Impact fall(Lab lab, const PartModelPtr& part, const Quat& orientation, double height, double seconds,
                   Phase phase = phases::pour) {
  double lowest = 0.0;
  for (const Vec3& v : part->mesh().vertices) lowest = std::min(lowest, (orientation * (v - part->mass().center)).z());
  lab.def().bin.friction = 0.0;
  const auto body = lab.place(part, Vec3(0.013, -0.007, height - lowest), orientation, material(0.0));
  const double speed = std::sqrt(2.0 * g * height), until = std::sqrt(2.0 * height / g) + seconds;
  const auto energy = [&] { return lab.kinetic_energy(body) + g * (lab.center(body).z() + lowest); };
  lab.begin(phase);
  Impact out{0.0, 0.0, {}};
  while (lab.time() < until) {
    lab.simulate(0.01);
    out.aside = std::max(out.aside, lab.state(body).velocity.linear.head<2>().norm() / speed);
    out.gain = std::max(out.gain, energy() / (g * height) - 1.0);
    out.path.push_back(lab.center(body));
  }
  return out;
}

/// Farthest that two paths are apart (m).
inline double path_difference(const Impact& a, const Impact& b) {
  double most = 0.0;
  for (std::size_t i = 0; i < std::min(a.path.size(), b.path.size()); ++i)
    most = std::max(most, (a.path[i] - b.path[i]).norm());
  return most;
}

/// Turns of a part so that it meets the ground with a corner, an edge or a face first. Edges and faces are those of the
/// largest triangle that lies on the part's convex hull.
enum class First { corner, edge, face };
inline Quat turned_to(First first, const PartModelPtr& part, std::uint64_t seed) {
  Random random(seed, 1, Stream::probe);
  const Quat any = random.orientation();
  if (first == First::corner) return any;
  const Mesh& mesh = part->mesh();
  Vec3 normal = Vec3::UnitZ(), edge = Vec3::UnitX();
  double largest = 0.0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]], u = mesh.vertices[t[1]] - a, v = mesh.vertices[t[2]] - a;
    const Vec3 cross = u.cross(v);
    const auto above = [&](const Vec3& p) { return cross.normalized().dot(p - a) > 1e-6; };
    if (cross.norm() <= largest || std::any_of(mesh.vertices.begin(), mesh.vertices.end(), above)) continue;
    largest = cross.norm();
    normal = cross.normalized();
    edge = u.norm() > v.norm() ? u.normalized() : v.normalized();
  }
  const Quat flat = Quat::FromTwoVectors(normal, -Vec3::UnitZ());
  if (first == First::face) return flat;
  return Quat(Eigen::AngleAxisd(random.uniform(0.2, 0.6), flat * edge)) * flat;
}

/// Features that meet.
enum class Meeting { corner_face, edge_edge, face_face };

struct Exchange {
  double angle;     ///< between the first change of velocity and the exact normal, degrees
  double momentum;  ///< change of the sum / momentum of the first at the start
  double energy;    ///< highest / at the start
};
/// Two free boxes of unequal mass that meet at a metre a second, aslant and off centre, without friction.
inline Exchange meet(Lab lab, Meeting meeting, std::uint64_t seed) {
  Random random(seed, 0, Stream::probe);
  const Quat all = random.orientation();
  const auto about = [](double angle, const Vec3& axis) { return Quat(Eigen::AngleAxisd(angle, axis)); };
  const double half = 0.02, yaw = random.uniform(0.3, 1.2), diagonal = std::sqrt(2.0) * half;
  // The first comes down along z onto the second: `low` and `high`, how far they reach.
  Quat above = about(yaw, Vec3::UnitZ()), below = Quat::Identity();
  double low = half, high = half;
  if (meeting == Meeting::corner_face) {
    above = above * Quat::FromTwoVectors(Vec3(1, 1, 1).normalized(), -Vec3::UnitZ());
    low = std::sqrt(3.0) * half;
  } else if (meeting == Meeting::edge_edge) {
    above = above * about(M_PI / 4, Vec3::UnitX());
    below = about(M_PI / 4, Vec3::UnitY());
    low = high = diagonal;
  }
  lab.def().bin.kind = Bin::Kind::none;
  lab.def().gravity.setZero();
  const Vec3 aside(0.3 * half * random.uniform(-1, 1), 0.3 * half * random.uniform(-1, 1), 0);
  const auto cube = box(Vec3::Constant(2.0 * half));
  const double gap = random.uniform(0.001, 0.005);
  const auto a =
      lab.place(cube, all * Vec3(aside + Vec3(0, 0, low + high + gap)), all * above, material(0.0, 0.0, 0.2));
  const auto b = lab.place(cube, Vec3::Zero(), all * below, material(0.0, 0.0, 0.5));
  lab.start(a).velocity.linear = all * Vec3(0.2, 0.1, -1.0);
  const auto momentum = [&] { return Vec3(lab.momentum(a) + lab.momentum(b)); };
  const auto energy = [&] { return lab.kinetic_energy(a) + lab.kinetic_energy(b); };
  lab.begin(phases::pour);
  const Vec3 before = lab.state(a).velocity.linear, sum = momentum();
  const double energy_before = energy(), scale = lab.momentum(a).norm();
  Exchange out{180.0, 0.0, 0.0};
  while (lab.time() < 0.1) {
    lab.simulate(lab.solver().step_size());
    const Vec3 change = lab.state(a).velocity.linear - before;
    if (out.angle == 180.0 && change.norm() > 1e-3)
      out.angle = std::acos(std::min(1.0, change.normalized().dot(all * Vec3::UnitZ()))) * 180.0 / M_PI;
    out.momentum = std::max(out.momentum, (momentum() - sum).norm() / scale);
    out.energy = std::max(out.energy, energy() / energy_before);
  }
  return out;
}

/// A cube at a metre a second hits an equal one `distance` (m) away, which sleeps by then, without gravity. Returns the
/// largest error of both speeds afterwards / speed of the impact.
inline double error_of_impact_on_a_sleeper(Lab lab, double restitution, double distance) {
  const double edge = 0.05, speed = 1.0;
  lab.def().bin.kind = Bin::Kind::none;
  lab.def().gravity.setZero();
  const PartModelPtr cube = box(Vec3::Constant(edge));
  const auto still = lab.place(cube, Vec3::Zero(), Quat::Identity(), material(0.0, restitution));
  const auto comes = lab.place(cube, Vec3(-distance - edge, 0, 0), Quat::Identity(), material(0.0, restitution));
  lab.start(comes).velocity.linear = Vec3(speed, 0, 0);
  lab.begin(phases::pour);
  lab.simulate(0.6);
  const Vec3 pushed = 0.5 * (1.0 + restitution) * Vec3(speed, 0, 0), left = Vec3(speed, 0, 0) - pushed;
  return std::max((lab.state(still).velocity.linear - pushed).norm(),
                  (lab.state(comes).velocity.linear - left).norm()) /
         speed;
}

}  // namespace bin_scenes::testing
