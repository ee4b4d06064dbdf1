/// Vocabulary of the thesis solver's tests: shapes of few spheres, worlds of few bodies.
#pragma once

#include "bin_scenes/solver/thesis_solver.hpp"
#include "solver/thesis/world.hpp"

#include <Eigen/Eigenvalues>

#include <cstring>
#include <vector>

namespace bin_scenes::thesis::test {

inline std::vector<Sphere> ball(double radius) {
  return {{Vec3::Zero(), radius, Vec3::Zero()}};
}

/// `n` touching spheres along x.
inline std::vector<Sphere> rod(int n, double radius) {
  std::vector<Sphere> spheres;
  for (int i = 0; i < n; ++i) spheres.push_back({Vec3((2 * i - n + 1) * radius, 0, 0), radius, Vec3::Zero()});
  return spheres;
}

/// Surface of a block of nx x ny x nz spheres `pitch` apart; face spheres know their face's normal.
inline std::vector<Sphere> block(int nx, int ny, int nz, double radius, double pitch) {
  std::vector<Sphere> spheres;
  const int n[3] = {nx, ny, nz};
  for (int z = 0; z < nz; ++z)
    for (int y = 0; y < ny; ++y)
      for (int x = 0; x < nx; ++x) {
        const int at[3] = {x, y, z};
        Vec3 center, normal = Vec3::Zero();
        for (int a = 0; a < 3; ++a) {
          center[a] = (at[a] - 0.5 * (n[a] - 1)) * pitch;
          if (n[a] > 1) normal[a] = (at[a] == n[a] - 1) - (at[a] == 0);
        }
        const double sides = normal.cwiseAbs().sum();
        if (sides == 0.0 && nx > 1 && ny > 1 && nz > 1) continue;  // interior spheres cannot touch
        spheres.push_back({center, radius, sides == 1.0 ? normal : Vec3::Zero().eval()});
      }
  return spheres;
}
inline std::vector<Sphere> cube(int n, double radius, double tightness = 1.0) {
  return block(n, n, n, radius, 2.0 * radius * tightness);
}

/// A shape whose spheres are points of equal mass (equation 2.31 of the thesis); a single sphere counts as solid.
inline Shape make_shape(const std::vector<Sphere>& spheres) {
  MassProperties mass;
  mass.volume = 1.0;
  for (const Sphere& sphere : spheres) mass.center += sphere.center / static_cast<double>(spheres.size());
  // Points on a line have no inertia about it: a tenth of a sphere's own keeps every axis turnable.
  const double own = (spheres.size() == 1 ? 0.4 : 0.04) * spheres.front().radius * spheres.front().radius;
  mass.inertia = own * Mat3::Identity();
  for (const Sphere& sphere : spheres) {
    const Vec3 r = sphere.center - mass.center;
    mass.inertia += (r.squaredNorm() * Mat3::Identity() - r * r.transpose()) / static_cast<double>(spheres.size());
  }
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(mass.inertia);
  mass.principal = solver.eigenvalues();
  Mat3 axes = solver.eigenvectors();
  if (axes.determinant() < 0.0) axes.col(2) *= -1.0;
  mass.principal_axes = Quat(axes);
  return thesis::make_shape(spheres, mass);
}

struct WorldBuilder {
  WorldDef def;
  std::vector<Shape> shapes;
  std::vector<BodyState> starts;

  std::size_t shape(const std::vector<Sphere>& spheres) {
    shapes.push_back(make_shape(spheres));
    return shapes.size() - 1;
  }
  std::size_t body(std::size_t shape, const Vec3& position, const Vec3& velocity = Vec3::Zero(), double mass = 1.0,
                   double friction = 0.5, double restitution = 0.0, bool fixed = false) {
    def.bodies.push_back({shape, mass, friction, restitution, fixed});
    starts.push_back({{position, Quat::Identity()}, {velocity, Vec3::Zero()}});
    return starts.size() - 1;
  }
  WorldBuilder& floor(double friction = 0.5) {
    def.bin.kind = Bin::Kind::floor;
    def.bin.friction = friction;
    return *this;
  }
  WorldBuilder& nothing() {
    def.bin.kind = Bin::Kind::none;
    def.gravity = Vec3::Zero();
    return *this;
  }
  WorldId add(ThesisSolver& solver, const ThesisSettings& settings = {}) const {
    const WorldId id = solver.add_world(make_world(def, shapes, settings));
    for (std::size_t b = 0; b < starts.size(); ++b) solver.insert(id, b, starts[b]);
    return id;
  }
};

inline ThesisSettings settings_with(double tightness, int sub_steps = 1) {
  ThesisSettings settings;
  settings.tightness = tightness;
  settings.sub_steps = sub_steps;
  return settings;
}

/// FNV-1a of all states, bit for bit.
inline std::uint64_t hash_of(const std::vector<BodyState>& states) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  const auto add = [&](const double* values, int n) {
    for (int i = 0; i < n; ++i) {
      std::uint64_t bits;
      std::memcpy(&bits, values + i, sizeof bits);
      hash = (hash ^ bits) * 0x100000001b3ULL;
    }
  };
  for (const BodyState& s : states) {
    add(s.pose.position.data(), 3);
    add(s.pose.orientation.coeffs().data(), 4);
    add(s.velocity.linear.data(), 3);
    add(s.velocity.angular.data(), 3);
  }
  return hash;
}

}  // namespace bin_scenes::thesis::test
