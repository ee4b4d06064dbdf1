/// The solver `bullet`: rigid bodies as compounds of convex hulls, stepped by Bullet in double precision on the CPU.
/// This header exposes nothing of Bullet; only the folder src/solver/bullet includes its headers.
///
/// Bullet's tolerances are plain numbers made for bodies of about one unit, so each world is simulated in a scale in
/// which the median part's bounding diagonal is one unit; poses and velocities are converted at this interface.
/// Time is never scaled.
#pragma once

#include "bin_scenes/solver/solver.hpp"

#include <memory>

namespace bin_scenes {

/// One Bullet world per WorldId, stepped one after the other: a world alone gives the same bits as in a batch.
/// Throws an input Error for settings that make no sense.
std::unique_ptr<Solver> make_bullet_solver(const BulletSettings& settings);

}  // namespace bin_scenes
