/// Computes the gap of a part at rest: the distance that it could fall before another surface supports it. It is a
/// measure of errors, after the simulation, and does not depend on the solver.
#pragma once

#include "placed.hpp"

#include "bin_scenes/scene/request.hpp"

namespace bin_scenes {

/// Returns the free distance (m) along `down` (unit vector, bin frame) of each part at rest, in the order of `placed`.
/// It is infinite for parts with nothing below them, and for parts that are not at rest; none falls if `down` is 0.
/// Overlap alone does not hold a part: the two parts are first moved apart by the shortest displacement, then the fall
/// is measured. Thus a sideways overlap lets a part fall freely, an overlap with a part below holds it at once.
/// @param overlaps  all pairs of parts that overlap, however little
std::vector<double> free_falls(const std::vector<Placed>& placed, const std::vector<Overlapping>& overlaps,
                               const Request& request, const MeshQuery* bin_mesh, const Vec3& down);

}  // namespace bin_scenes
