/// Vocabulary of scenes with few bodies, shared by tests and benchmarks: "drop this part, simulate two seconds".
#pragma once

#include "bin_scenes/solver/solver.hpp"
#include "pour/settling.hpp"

#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <utility>
#include <vector>

namespace bin_scenes::testing {

inline Mesh merged(Mesh a, const Mesh& b) {
  const auto offset = static_cast<std::uint32_t>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const Triangle& t : b.triangles) a.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  return a;
}

inline Mesh box_mesh(const Vec3& size, const Vec3& center = Vec3::Zero()) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.push_back(center + 0.5 * size.cwiseProduct(Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

/// Icosahedron, each triangle split into four `subdivisions` times, on the sphere.
inline Mesh sphere_mesh(double radius, int subdivisions = 3) {
  const double g = 0.5 * (1.0 + std::sqrt(5.0));
  Mesh mesh;
  mesh.vertices = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                   {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (int s = 0; s < subdivisions; ++s) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [it, fresh] = middles.try_emplace(std::minmax(a, b), mesh.vertices.size());
      if (fresh) mesh.vertices.push_back(0.5 * (mesh.vertices[a] + mesh.vertices[b]));
      return it->second;
    };
    std::vector<Triangle> finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    mesh.triangles = finer;
    for (Vec3& v : mesh.vertices) v.normalize();
  }
  for (Vec3& v : mesh.vertices) v = radius * v.normalized();
  return mesh;
}

/// Upright, with flat faces at heights `low` and `high`.
inline Mesh prism_mesh(std::uint32_t sides, double radius, double low, double high) {
  Mesh mesh;
  for (const double z : {low, high})
    for (std::uint32_t k = 0; k < sides; ++k) {
      const double angle = 2.0 * M_PI * k / sides;
      mesh.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
    }
  for (std::uint32_t k = 0; k < sides; ++k) {
    const std::uint32_t next = (k + 1) % sides;
    mesh.triangles.insert(mesh.triangles.end(), {{k, next, sides + next}, {k, sides + next, sides + k}});
    if (k > 1) mesh.triangles.insert(mesh.triangles.end(), {{0, k, k - 1}, {sides, sides + k - 1, sides + k}});
  }
  return mesh;
}

/// A square plate, its upper face at 0, of `cells` by `cells` squares on each large face.
inline Mesh plate_mesh(double side, double thickness, int cells) {
  Mesh mesh;
  const auto n = static_cast<std::uint32_t>(cells + 1);
  for (const double z : {-thickness, 0.0})
    for (std::uint32_t i = 0; i < n; ++i)
      for (std::uint32_t j = 0; j < n; ++j)
        mesh.vertices.emplace_back(side * (static_cast<double>(i) / cells - 0.5),
                                   side * (static_cast<double>(j) / cells - 0.5), z);
  const std::uint32_t top = n * n;
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  for (std::uint32_t i = 0; i + 1 < n; ++i)
    for (std::uint32_t j = 0; j + 1 < n; ++j) {
      const std::uint32_t a = i * n + j, b = a + n, c = b + 1, d = a + 1;
      quad(top + a, top + b, top + c, top + d);
      quad(a, d, c, b);
    }
  for (std::uint32_t i = 0; i + 1 < n; ++i) {
    const std::uint32_t last = n * (n - 1);
    quad(i, top + i, top + i + 1, i + 1);                                                      // -x
    quad(last + i, last + i + 1, top + last + i + 1, top + last + i);                          // +x
    quad(i * n, (i + 1) * n, top + (i + 1) * n, top + i * n);                                  // -y
    quad(i * n + n - 1, top + i * n + n - 1, top + (i + 1) * n + n - 1, (i + 1) * n + n - 1);  // +y
  }
  return mesh;
}

/// A part made of `count` boxes along a circle: concave, a union of convex pieces known exactly.
inline Mesh ring_mesh(int count, double inner, double outer, double height) {
  Mesh mesh;
  for (int k = 0; k < count; ++k) {
    Mesh piece = box_mesh(Vec3(1, 1, height));
    for (std::size_t i = 0; i < 8; ++i) {
      const double angle = 2.0 * M_PI * (k + (i & 2 ? 1 : 0)) / count, radius = i & 1 ? outer : inner;
      piece.vertices[i].head<2>() = radius * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    }
    mesh = merged(mesh, piece);
  }
  return mesh;
}

inline PartModelPtr box(const Vec3& size) {
  return PartModel::from_mesh(box_mesh(size), "box");
}
inline PartModelPtr sphere(double radius) {
  return PartModel::from_mesh(sphere_mesh(radius, 4), "sphere");
}

/// What scenes stand on: the bin's floor, or a mesh with its upper face there. What holds on the one holds on the
/// others.
enum class Ground { floor, plate, turned_plate, heavy_plate };
inline const char* name_of(Ground ground) {
  return std::array{"floor", "plate", "turned_plate", "heavy_plate"}[static_cast<std::size_t>(ground)];
}

/// One world of one solver, with its bodies' properties in reach. Scenes are told as if they stood on the floor: where
/// they stand on a turned plate, the world is turned with it.
class Lab {
 public:
  /// What was simulated, of all labs that share it.
  struct Count {
    double seconds = 0.0;
    std::uint64_t steps = 0;  ///< as they were done: cut ones, not those asked for
  };
  explicit Lab(std::unique_ptr<Solver> solver, Count* count = nullptr, Ground ground = Ground::floor)
      : solver_(std::move(solver)), count_(count), ground_(ground) {
    def_.bin.kind = Bin::Kind::floor;
  }

  WorldDef& def() { return def_; }
  Solver& solver() { return *solver_; }
  WorldId world() const { return world_; }

  /// Adds a body at rest with its centre of mass at `center`; returns its index.
  std::size_t place(const PartModelPtr& part, const Vec3& center, const Quat& orientation = Quat::Identity(),
                    BodyDef body = {}) {
    std::size_t p = 0;
    while (p < def_.parts.size() && def_.parts[p] != part) ++p;
    if (p == def_.parts.size()) def_.parts.push_back(part);
    body.part = p;
    def_.bodies.push_back(body);
    starts_.push_back({{center - orientation * part->mass().center, orientation}, {}});
    return starts_.size() - 1;
  }
  BodyState& start(std::size_t body) { return starts_[body]; }

  void begin(Phase phase) {
    const std::size_t bodies = placed_ = starts_.size();
    if (def_.bin.kind == Bin::Kind::floor && ground_ != Ground::floor) lay_plate();
    WorldDef turned = def_;
    turned.gravity = turn_ * def_.gravity;
    if (starts_.size() > bodies && ground_ != Ground::heavy_plate) turned.bin.kind = Bin::Kind::none;
    if (ground_ == Ground::heavy_plate) turned.bin.friction = 100.0;  // the plate stays where it is
    world_ = solver_->add_world(turned);
    for (std::size_t b = 0; b < starts_.size(); ++b) set_state(b, starts_[b]);
    solver_->set_phase(world_, phase);
    begun_ = true;
  }
  void simulate(double seconds) {
    if (!begun_) begin(phases::pour);
    const std::uint64_t before = solver_->steps(world_);
    const double done = solver_->advance({world_}, seconds);
    time_ += done;
    if (!count_) return;
    count_->seconds += done;
    count_->steps += solver_->steps(world_) - before;
  }
  double time() const { return time_; }

  std::vector<BodyState> states() const {
    std::vector<BodyState> states = solver_->states(world_);
    for (BodyState& state : states) {
      const Quat back = turn_.conjugate();
      state = {{back * (state.pose.position - rise_), back * state.pose.orientation},
               {back * state.velocity.linear, back * state.velocity.angular}};
    }
    return states;
  }
  void set_state(std::size_t body, const BodyState& state) {
    solver_->insert(world_, body,
                    {{turn_ * state.pose.position + rise_, turn_ * state.pose.orientation},
                     {turn_ * state.velocity.linear, turn_ * state.velocity.angular}});
  }
  BodyState state(std::size_t body) const { return states()[body]; }
  /// Force on a body from another, -1 for the bin or what was laid there in its place, and its moment about the centre
  /// of mass of the body (N, N m).
  struct Wrench {
    Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
  };
  Wrench wrench(std::size_t body, int other) const {
    const auto bin = [&](int b) { return b < 0 || static_cast<std::size_t>(b) >= placed_; };
    const Quat back = turn_.conjugate();
    Wrench sum;
    for (const ContactForce& f : solver_->contact_forces(world_)) {
      const bool first = f.a == static_cast<int>(body);
      if (!first && f.b != static_cast<int>(body)) continue;
      const int from = first ? f.b : f.a;
      if (other < 0 ? !bin(from) : from != other) continue;
      const Vec3 force = back * (first ? Vec3(-f.force) : f.force);
      sum.force += force;
      sum.moment += (back * (f.point - rise_) - center(body)).cross(force);
    }
    return sum;
  }
  const BodyDef& body(std::size_t body) const { return def_.bodies[body]; }
  const PartModel& part(std::size_t body) const { return *def_.parts[def_.bodies[body].part]; }
  Vec3 center(std::size_t body) const { return state(body).pose * part(body).mass().center; }
  Vec3 momentum(std::size_t body) const { return def_.bodies[body].mass * state(body).velocity.linear; }
  /// About the centre of mass, bin frame.
  Vec3 spin(std::size_t body) const { return spin(body, state(body)); }
  Vec3 spin(std::size_t body, const BodyState& state) const {
    const Mat3 R = state.pose.orientation.toRotationMatrix();
    const MassProperties& mass = part(body).mass();
    return R * mass.inertia * R.transpose() * state.velocity.angular * (def_.bodies[body].mass / mass.volume);
  }
  double kinetic_energy(std::size_t body) const { return kinetic_energy(body, state(body)); }
  double kinetic_energy(std::size_t body, const BodyState& state) const {
    const Twist& v = state.velocity;
    return 0.5 * def_.bodies[body].mass * v.linear.squaredNorm() + 0.5 * v.angular.dot(spin(body, state));
  }

 private:
  /// A fixed plate, turned by 30 degrees and of 1,152 triangles a face, or one that lies on the floor, of ten tons.
  void lay_plate() {
    const double side = 3.0, thickness = 0.05;
    const bool turned = ground_ == Ground::turned_plate, heavy = ground_ == Ground::heavy_plate;
    BodyDef plate;
    plate.friction = def_.bin.friction;
    plate.restitution = def_.bin.restitution;
    plate.fixed = !heavy;
    plate.mass = 1e4;
    const PartModelPtr part = PartModel::from_mesh(plate_mesh(side, thickness, turned ? 24 : 1), "plate");
    if (turned) turn_ = Quat(Eigen::AngleAxisd(M_PI / 6, Vec3(1, 2, 3).normalized()));
    if (heavy) rise_ = Vec3(0, 0, thickness);
    place(part, Vec3(0, 0, -0.5 * thickness), Quat::Identity(), plate);
  }

  std::unique_ptr<Solver> solver_;
  Count* count_;
  Ground ground_;
  Quat turn_ = Quat::Identity();  ///< of the world against the scene
  Vec3 rise_ = Vec3::Zero();
  WorldDef def_;
  std::vector<BodyState> starts_;
  std::size_t placed_ = 0;  ///< bodies of the scene: a plate comes behind them
  WorldId world_ = 0;
  bool begun_ = false;
  double time_ = 0.0;
};

inline BodyDef material(double friction, double restitution = 0.0, double mass = 1.0) {
  BodyDef body;
  body.friction = friction;
  body.restitution = restitution;
  body.mass = mass;
  return body;
}

}  // namespace bin_scenes::testing
