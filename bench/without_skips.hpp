/// What skips of the default solver save that no setting turns off: the same fall with and without each, on the world
/// itself.
#pragma once

#include "framework/table.hpp"
#include "solver/sphere/world.hpp"

#include <functional>
#include <string>
#include <vector>

namespace bin_scenes::bench {

/// What a skip may be taken away from, before a world begins.
struct SkipTarget {
  sphere::World& world;
  sphere::Shape& shape;
};

/// A skip of the solver's passes, and how it is taken away.
struct Skip {
  std::string name, off;  ///< as the table shows them
  std::function<void(SkipTarget&)> take_away;
};

/// The skips that can be taken away; each leaves alone what it does not name.
const std::vector<Skip>& pass_skips();

/// CPU seconds in which `count` parts fall in a box for `seconds` (s, simulated), with everything skipped that is
/// (`without` null) or without one skip; how much work was done, and whether the poses have the bits of the former.
Row fall_row(const std::string& part, std::size_t count, double seconds, const Skip* without);

}  // namespace bin_scenes::bench
