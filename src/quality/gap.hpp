/// Computes the gap of a part at rest: the distance that it could fall before another surface supports it. It is a
/// measure of errors, after the simulation, and does not depend on the solver.
#pragma once

#include "placed.hpp"

#include "bin_scenes/scene/request.hpp"

namespace bin_scenes {

/// Free distance along `down` (unit, bin frame; 0: none falls) of every resting part, in the order of `placed`; parts
/// with nothing at all below them, and those not at rest, have an infinite one. Overlap does not hold a part by itself:
/// the two are first moved apart by the shortest displacement, then the fall is measured, so that what overlaps
/// sideways falls freely, and what overlaps from below is held at once.
/// @param overlaps all that overlap, however little
std::vector<double> free_falls(const std::vector<Placed>& placed, const std::vector<Overlapping>& overlaps,
                               const Request& request, const MeshQuery* bin_mesh, const Vec3& down);

}  // namespace bin_scenes
