/// Unites the overlapping closed shells of a part into one solid, so that its volume counts only once. It is the last
/// step of the repair in mesh_loader.cpp that changes the mesh.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"

#include <cstddef>

namespace bin_scenes::repair {

/// Pairs of solid shells of a closed mesh that overlap, found by points of one inside the other: at up to 200 triangle
/// centres and edge middles of each. Shallow overlaps may escape it. Cavities are not solid and do not count.
std::size_t overlapping_pairs(const Mesh& mesh);

/// Replaces a closed mesh of overlapping solid shells by the boundary of their union: triangles are cut where those of
/// other shells cross them, and the pieces inside another solid are left out. What remains is welded at `tolerance` and
/// closed at its T-junctions; where that leaves gaps, it is done again from the start with other tolerances, of a tenth
/// to three times as much. False, and the mesh is as it was, if no tolerance closes it, or it would take too long.
bool unite(Mesh& mesh, double tolerance);

}  // namespace bin_scenes::repair
