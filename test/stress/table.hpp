/// The suite's results as rows: survived / tried, for the console and as CSV.
#pragma once

#include "stress/trial.hpp"

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace bin_scenes::stress {

/// From the strictest to the mildest of a row's cases; infinite where nothing is asked.
struct LimitRange {
  double least = std::numeric_limits<double>::infinity(), most = 0.0;
  void extend(double limit);
};

/// One row under one solver.
struct Tally {
  std::string theme, row, solver, device;
  std::size_t tried = 0, survived = 0, flagged = 0;  ///< cases
  double penetration = 0.0, drift = 0.0, energy = 0.0, cpu_s = 0.0, simulated_s = 0.0, peak_mb = 0.0;
  LimitRange penetration_limit, energy_limit;  ///< of Expect
  std::uint64_t steps = 0;
  bool flat = false;                      ///< memory and time were looked at over many scenes (Expect::flat)
  double growth_bytes = 0.0, pace = 1.0;  ///< as in Outcome
  std::vector<std::string> failures;      ///< "case: what; what (known: why)"

  void add(const Case& c, const Outcome& outcome, const std::string& why_known);
  double mean_step() const { return steps ? simulated_s / static_cast<double>(steps) : 0.0; }  ///< s, as it was cut
};

/// As bin_scenes_bench keeps its tables: host and command above, survived / tried compared exactly.
void write_csv(const std::string& path, const std::vector<Tally>& rows, const std::string& command);

}  // namespace bin_scenes::stress
