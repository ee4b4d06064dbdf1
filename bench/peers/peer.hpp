/// Other engines behind this project's Solver interface: the same pour, the same start poses, the same verdict on rest,
/// on the parts' exact convex pieces. ODE and DART run with the settings their own manuals give for piles; lengths are
/// scaled so that a part's diagonal is 1, masses so that a part weighs 1, since their tolerances are plain numbers.
#pragma once

#include "bin_scenes/solver/solver.hpp"
#include "referee.hpp"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace bin_scenes::bench {

constexpr double bullet_stock_margin = 0.002;  ///< m around each hull: what rests, rests so far above the floor

/// By an engine's own sleeping, if it has one and it is on: slow is below its thresholds, asleep is so for its time.
enum class PeerRest { moves, slow, asleep };

struct PeerSettings {
  std::string engine;  ///< "bullet_stock", "ode", "dart"
  double time_step = 0.01;
  int iterations = 20;         ///< sweeps of the contact solver per step
  std::vector<Pieces> pieces;  ///< by part of the world (m)
  std::vector<double> balls;   ///< by part: radius of one that is a ball, else 0; if empty, none is. Bullet alone
  double margin = bullet_stock_margin;
  /// Told after each step: simulated time, and the least rest of all bodies (moves while one is not in yet).
  std::function<void(double simulated_s, PeerRest rest)> watch;
};

/// What an engine has to do; units of the caller (m, kg, s).
class PeerWorld {
 public:
  virtual ~PeerWorld() = default;
  virtual void insert(std::size_t body, const BodyState& state) = 0;
  virtual void remove(std::size_t body) = 0;
  virtual void step(double dt) = 0;
  virtual BodyState state(std::size_t body) const = 0;  ///< of a body that is in
  virtual PeerRest rest(std::size_t) const { return PeerRest::moves; }
};

/// Names of the engines that this build has.
std::vector<std::string> peers_built();

/// Throws an input Error for an engine that is not built, or for pieces that it has no shape for.
std::unique_ptr<Solver> make_peer(const PeerSettings& settings);

std::unique_ptr<PeerWorld> make_bullet_world(const WorldDef& def, const PeerSettings& settings);
std::unique_ptr<PeerWorld> make_ode_world(const WorldDef& def, const PeerSettings& settings);
std::unique_ptr<PeerWorld> make_dart_world(const WorldDef& def, const PeerSettings& settings);

/// A piece that is a box along the axes of its part: what every engine collides best.
bool is_box(const std::vector<Vec3>& piece, Aabb& box);

/// Lengths and masses of an engine's world in units of the caller's: 1 / diagonal, 1 / mass of the first body.
struct PeerScale {
  double length, mass;
  explicit PeerScale(const WorldDef& def);
};

}  // namespace bin_scenes::bench
