/// Parts as unions of prisms, in files: as a CAD part, and as the exact pieces that the referee wants.
#pragma once

#include "bin_scenes/core/types.hpp"

#include <string>
#include <vector>

namespace bin_scenes::bench {

/// Corners of a convex prism or frustum (mm): two rings of as many, the lower first, both counterclockwise when looked
/// at from above.
using Prism = std::vector<Vec3>;

/// Writes FOLDER/part.obj, the prisms as overlapping solids of one file, and FOLDER/hull_KK.obj, their vertices alone
/// as in models/pieces.
void write_pieces(const std::string& folder, const std::vector<Prism>& prisms);

}  // namespace bin_scenes::bench
