/// The solver `bullet`: parts are rigid compounds of convex hulls, which Bullet simulates in double precision on the
/// CPU. This header exposes nothing of Bullet; only the folder src/solver/bullet includes its headers.
///
/// Bullet's tolerances are fixed numbers for bodies of about one unit. Each world is therefore simulated at a scale at
/// which the median diagonal of the parts is one unit, and poses and velocities are converted at this interface. Time
/// is never scaled.
#pragma once

#include "bin_scenes/solver/solver.hpp"

#include <memory>

namespace bin_scenes {

/// Returns a solver with one Bullet world for each WorldId. Worlds are simulated one after the other, so that a world
/// alone gives the same bits as in a batch. Throws an input Error for impossible settings.
std::unique_ptr<Solver> make_bullet_solver(const BulletSettings& settings);

}  // namespace bin_scenes
