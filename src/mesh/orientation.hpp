/// Determines which side of a surface is outside, and turns triangles whose winding disagrees with that. It is one step
/// of the repair in mesh_loader.cpp; it moves no vertex.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"

#include <cstddef>

namespace bin_scenes::repair {

/// Turns triangles so that neighbours agree on the side that is outside; in each shell the majority decides.
struct Agreement {
  std::size_t turned = 0;     ///< number of triangles that were turned
  std::size_t conflicts = 0;  ///< edges that cannot be satisfied: the surface has only one side (Moebius)
};
Agreement agree_winding(Mesh& mesh);

/// Turns every outermost closed shell that encloses negative volume inside out, with all shells inside it: a cavity
/// stays a cavity. Returns the number of triangles turned.
std::size_t turn_outward(Mesh& mesh);

}  // namespace bin_scenes::repair
