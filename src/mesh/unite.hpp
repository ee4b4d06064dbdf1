/// Unites the overlapping closed shells of a part into one solid, so that its volume counts only once. It is the last
/// step of the repair in mesh_loader.cpp that changes the mesh.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"

#include <cstddef>

namespace bin_scenes::repair {

/// Returns the number of pairs of solid shells of a closed mesh that overlap. Up to 200 centres of triangles and edges
/// of each shell are tested for being inside the other; shallow overlaps may be missed. Cavities do not count.
std::size_t overlapping_pairs(const Mesh& mesh);

/// Replaces a closed mesh of overlapping solid shells by the boundary of their union: triangles are cut where triangles
/// of other shells cross them, and pieces inside another solid are removed. The rest is welded at `tolerance` and
/// closed at its T-junctions; if gaps remain, the work is repeated with other tolerances, of a tenth to three times as
/// much. Returns false, and leaves the mesh unchanged, if no tolerance closes it or if the work would take too long.
bool unite(Mesh& mesh, double tolerance);

}  // namespace bin_scenes::repair
