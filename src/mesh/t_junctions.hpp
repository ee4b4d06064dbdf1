/// Repairs T-junctions: a long edge that meets several short ones is split at their end points, so that the surface
/// becomes closed. It is one step of the repair in mesh_loader.cpp, after welding.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"

#include <cstddef>

namespace bin_scenes::repair {

/// Splits open edges at the vertices of other open edges that lie on them within `tolerance`: such an edge meets two
/// shorter ones on its other side, without a gap. Returns the number of vertices inserted.
std::size_t split_t_junctions(Mesh& mesh, double tolerance);

}  // namespace bin_scenes::repair
