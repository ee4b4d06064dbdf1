/// Computes the effort of a heap: the factor by which the solver multiplies its work on contacts (World::effort). It is
/// 1 for a few layers of thick parts with equal masses, and larger for deep heaps, towers and unequal masses.
#pragma once

#include "solver/sphere/world.hpp"

#include "bin_scenes/solver/solver.hpp"

namespace bin_scenes::sphere {

/// Effort of the heap that this world will become, when all parts that find room are in.
int effort_to_come(const World& world, const WorldDef& def);

/// Of the heaviest part that moves to the lightest.
float mass_ratio_of(const World& world);

/// Sweeps that parts of unequal masses ask for, times the default: a sweep passes on as much of an impact as the light
/// part that carries it can.
int effort_of_masses(const World& world);

/// Settings::push_speed with which a contact of the lightest part carries the heaviest one.
float push_speed_of_masses(const World& world);

/// Effort of the heap as it lies now.
int effort_of(const World& world);

}  // namespace bin_scenes::sphere
