/// Parts that nobody tuned a solver to, made of convex pieces that are known exactly, so that the referee can judge
/// piles of them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace bin_scenes::bench {

/// Writes a part drawn from a seed to FOLDER/part.obj, and its pieces to FOLDER/pieces.obj, as in models/pieces (mm).
/// Two to six prisms with 4 to 10 sides, some tapered, turned by right angles or freely, each through some place of an
/// earlier one; 45 to 65 mm from corner to corner of the bounding box, no piece thinner than a twentieth of that.
/// Returns the number of pieces.
int write_random_part(const std::string& folder, std::uint64_t seed);

/// Parts that are mostly edge or face, where a solver that knows a part by samples has the least to hold it by: sheet,
/// disc, lattice, comb, frame, tube, wire_ring, spring; 45 to 71 mm from corner to corner, 0.5 to 4 mm thick.
std::vector<std::string> thin_parts();
/// Writes the part of that name in the same way. Throws Error on other names.
int write_thin_part(const std::string& folder, const std::string& name);

}  // namespace bin_scenes::bench
