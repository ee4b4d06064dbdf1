/// Turns an open surface into a closed solid of a given thickness. It serves sheet-metal parts that are modelled as
/// surfaces (the key `thickness` of a part).
#pragma once

#include "bin_scenes/mesh/mesh.hpp"

#include <cstddef>

namespace bin_scenes::repair {

/// Makes an open surface a closed shell of `thickness`: both sides are offset by half of it along the vertex normals,
/// and the rims are joined. At folds, the offset grows so that faces keep their distance (at most twice the thickness).
void thicken(Mesh& mesh, double thickness);

}  // namespace bin_scenes::repair
