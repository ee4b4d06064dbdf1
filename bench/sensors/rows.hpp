/// Rows of the benchmark `sensors`: one figure a row, with its unit and its goal. Each function adds the rows of one
/// subject.
#pragma once

#include "framework/benchmark.hpp"

namespace bin_scenes::bench {

/// Columns that name a row. Distances are those of the plate or the heap along the camera's axis.
struct Figure {
  std::string what;
  double distance_m = 1.0, incidence_deg = 0.0, albedo = 0.5;
  std::string setting = "";  ///< what else differs: fidelity, number of steps, window
  Row key() const;
};
/// @param unit  of the value
/// @param goal  limit in words, "at most 0.02"; empty: no goal, the row only explains others
Row row_of(const Figure& figure, double value, const std::string& unit, const std::string& goal = "");

void truth_rows(Run& out);   ///< images without a sensor's errors, shadows, visible fractions against a ray cast
void fringe_rows(Run& out);  ///< structured light: errors, noise over its formula, both fidelities
void light_rows(Run& out);   ///< structured light in a V-groove, by albedo, period and bounces
void stereo_rows(Run& out);  ///< errors of the matcher resemble each other within its window
void time_rows(Run& out);    ///< wall and CPU seconds of a view, and what is computed when nobody asks

}  // namespace bin_scenes::bench
