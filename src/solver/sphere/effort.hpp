/// Computes the effort of a heap: the factor by which the solver multiplies its work on contacts (World::effort). It is
/// 1 for a few layers of thick parts with equal masses, and larger for deep heaps, towers and unequal masses.
#pragma once

#include "solver/sphere/world.hpp"

#include "bin_scenes/solver/solver.hpp"

namespace bin_scenes::sphere {

/// Returns the effort of the full heap, in which all parts of `def` that find room are in the bin.
int effort_to_come(const World& world, const WorldDef& def);

/// Returns the mass of the heaviest moving part divided by the mass of the lightest one.
float mass_ratio_of(const World& world);

/// Returns the factor of the number of sweeps that parts of unequal masses need: a sweep propagates only as much of an
/// impact as the light part between two heavy ones can carry.
int effort_of_masses(const World& world);

/// Returns the value of Settings::push_speed with which a contact of the lightest part supports the heaviest one.
float push_speed_of_masses(const World& world);

/// Returns the effort of the heap in its present state.
int effort_of(const World& world);

}  // namespace bin_scenes::sphere
