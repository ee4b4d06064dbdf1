/// Turns an open surface into a closed solid of a given thickness. It serves sheet-metal parts that are modelled as
/// surfaces (the key `thickness` of a part).
#pragma once

#include "bin_scenes/mesh/mesh.hpp"

#include <cstddef>

namespace bin_scenes::repair {

/// An open surface as a closed shell of `thickness`: both sides offset by half of it along the vertex normals, the
/// rims joined. At folds the offset grows so that the faces keep their distance (at most twice the thickness).
void thicken(Mesh& mesh, double thickness);

}  // namespace bin_scenes::repair
