/// The suite's results as rows: survived / tried, for the console, CSV and the table of docs/stress.md.
#pragma once

#include "stress/trial.hpp"

#include <string>
#include <vector>

namespace bin_scenes::stress {

/// One row under one solver.
struct Tally {
  std::string theme, row, solver, device;
  std::size_t tried = 0, survived = 0;
  double penetration = 0.0, drift = 0.0, energy = 0.0, cpu_s = 0.0, simulated_s = 0.0, peak_mb = 0.0;
  std::vector<std::string> failures;  ///< "case: what; what (known: why)"

  void add(const std::string& case_name, const Outcome& outcome, const std::string& why_known);
};

/// As bin_scenes_bench keeps its tables: host and command above, survived / tried compared exactly.
void write_csv(const std::string& path, const std::vector<Tally>& rows, const std::string& command);
/// Replaces what lies between the two marks of an existing file: docs/stress.md is prose around a table.
void write_table(const std::string& path, const std::vector<Tally>& rows, const std::string& command);

}  // namespace bin_scenes::stress
