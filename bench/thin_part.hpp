/// Parts that are mostly edge or face: where a solver that knows a part by samples has the least to hold it by.
#pragma once

#include <string>
#include <vector>

namespace bin_scenes::bench {

/// sheet, disc, lattice, comb, frame, tube, wire_ring, spring: 45 to 71 mm from corner to corner of the bounding box, 0.5
/// to 4 mm thick.
const std::vector<std::string>& thin_parts();

/// Writes the part of that name and its pieces (write_pieces), and returns their number. Throws Error on other names.
int write_thin_part(const std::string& folder, const std::string& name);

}  // namespace bin_scenes::bench
