/// Divides an interval of simulated time into steps, and limits the length of a step for the parts that are simulated:
/// a step that is short for a part of 5 cm lets a part of half a millimetre fall by its own height. All solvers use
/// these functions, which are inline because the solvers are below this layer's library.
#pragma once

#include "bin_scenes/scene/report.hpp"
#include "core/formatted.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

namespace bin_scenes {

/// The steps into which an interval of simulated time is divided.
struct Steps {
  std::uint64_t whole = 0;
  double rest = 0.0;  ///< s, length of a last, shorter step; 0: none

  std::uint64_t count() const { return whole + (rest > 0.0 ? 1 : 0); }
};

/// Divides `seconds` into steps of `step` seconds. A remainder below a millionth of a step is a rounding error.
inline Steps steps_in(double seconds, double step) {
  constexpr double rounding = 1e-6;
  Steps steps;
  steps.whole = static_cast<std::uint64_t>(std::max(0.0, std::floor(seconds / step + rounding)));
  const double rest = seconds - static_cast<double>(steps.whole) * step;
  if (rest > rounding * step) steps.rest = rest;
  return steps;
}

/// Returns the number of steps into which a time step (s) must be divided for parts with the given smallest diagonal
/// (m) under gravity (m/s2): parts at rest then fall by no more than `fall` of that diagonal in one step. With steps
/// longer than those of the default, the contacts that support a heap are found too late: parts sink into each other
/// and, at 1/15 s, through the floor.
inline int step_cuts(double time_step, double gravity, double smallest_diagonal, double fall = 1.8e-3) {
  constexpr double most_cuts = 1000.0;
  const double longest = std::sqrt(2.0 * fall * smallest_diagonal / std::max(gravity, 1e-9));
  const double cuts = std::ceil(time_step / longest - 1e-6);
  return cuts > 1.0 ? static_cast<int>(std::min(cuts, most_cuts)) : 1;
}

/// Returns the flag that reports divided steps. `key`: name of the setting, for example "solver.sphere.time_step".
inline Flag step_cut_flag(const std::string& key, double time_step, int cuts, double smallest_diagonal) {
  const auto milli = [](double value) { return formatted("%.4g m", 1e3 * value); };
  return {"time_step_cut",
          "each time step of " + milli(time_step) + "s was cut in " + std::to_string(cuts) + ", since parts of " +
              milli(smallest_diagonal) + "m fall too far in one",
          "nothing to do, or set " + key + " to " + milli(time_step / cuts) + "s or less"};
}

}  // namespace bin_scenes
