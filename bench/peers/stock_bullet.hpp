/// Bullet 3.24 as it comes, behind this project's Solver interface: the same pour, the same start poses, the same
/// verdict on rest, on the parts' exact convex pieces. Its settings are those that users of it begin with: metres and
/// kilograms, sequential impulse at the world's own time step, hulls with a margin around them, sleeping with Bullet's
/// own thresholds (0.8 m/s, 1 rad/s for 2 s).
#pragma once

#include "bin_scenes/solver/solver.hpp"
#include "referee.hpp"

#include <functional>
#include <memory>
#include <vector>

namespace bin_scenes::bench {

/// By Bullet's own sleeping: slow is below its thresholds, asleep is so for its time.
enum class BulletRest { moves, slow, asleep };

struct StockBullet {
  double time_step = 0.01;
  int iterations = 10;         ///< sweeps of the contact solver per step
  std::vector<Pieces> pieces;  ///< by part of the world (m)
  std::vector<double> balls;   ///< by part: radius of one that is a ball, else 0; if empty, none is
  double damping = 0.0;        ///< linear and angular, share of a velocity lost in a second
  double margin = 0.002;       ///< m around each hull: parts rest so far above the floor
  /// Told after each step: simulated time, and the least rest of all bodies (moves while one is not in yet).
  std::function<void(double simulated_s, BulletRest rest)> watch;
};

std::unique_ptr<Solver> make_stock_bullet(const StockBullet& settings);

}  // namespace bin_scenes::bench
