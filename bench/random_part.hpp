/// Parts that nobody tuned a solver to: unions of convex pieces, drawn from a seed. The pieces are known exactly, so
/// that the referee can judge piles of them.
#pragma once

#include <cstdint>
#include <string>

namespace bin_scenes::bench {

/// Writes the part of a seed and its pieces (write_pieces). Two to six prisms with 4 to 10 sides, some tapered,
/// turned by right angles or freely, each through some place of an earlier one; 45 to 65 mm from corner to corner of
/// the bounding box, no piece thinner than a twentieth of that. Returns the number of pieces.
int write_random_part(const std::string& folder, std::uint64_t seed);

}  // namespace bin_scenes::bench
