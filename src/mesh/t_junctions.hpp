/// Long edges that meet several short ones.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"

#include <cstddef>

namespace bin_scenes::repair {

/// Splits open edges at the vertices of other open edges that lie on them within `tolerance`: there a long edge on
/// one side meets two short ones on the other, without a gap. Returns the number of vertices inserted.
std::size_t split_t_junctions(Mesh& mesh, double tolerance);

}  // namespace bin_scenes::repair
