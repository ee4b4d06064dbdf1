/// Determines which nodes of a grid are inside a mesh. It gives the distances of a distance field their sign.
#pragma once

#include "bin_scenes/part/distance_field.hpp"
#include "bin_scenes/part/mesh_query.hpp"

namespace bin_scenes {

/// Makes the values (distances in cells, not negative) of all nodes inside the mesh negative. A node is inside if the
/// generalised winding number is above one half (Jacobson et al. 2013, "Robust inside-outside segmentation using
/// generalized winding numbers").
void sign_field(DistanceField& field, const MeshQuery& query);

}  // namespace bin_scenes
