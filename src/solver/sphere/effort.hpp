/// How much work on contacts a heap needs, as times that of a few layers of thick parts of one mass: World::effort.
#pragma once

#include "solver/sphere/world.hpp"

#include "bin_scenes/solver/solver.hpp"

namespace bin_scenes::sphere {

/// Of the heap that a world is made for, once all is in it that finds room.
int effort_to_come(const World& world, const WorldDef& def);

/// Of the heap as it lies.
int effort_of(const World& world);

}  // namespace bin_scenes::sphere
