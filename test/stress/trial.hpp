/// One case under one solver: run it, and say what did not hold.
#pragma once

#include "stress/stress.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace bin_scenes::stress {

struct Outcome {
  std::vector<std::string> failures;  ///< empty = survived
  std::vector<std::string> flags;     ///< of contacts that are not to be trusted, as the report words them
  double penetration = 0.0;           ///< largest / smaller diagonal, bin included
  double drift = 0.0;                 ///< largest / diagonal, of scenes called resting
  double energy = 0.0;                ///< largest gain
  double simulated_s = 0.0;           ///< all scenes
  std::uint64_t steps = 0;            ///< in that time, as they were cut
  double cpu_s = 0.0, peak_mb = 0.0;  ///< of the process
  double growth_bytes = 0.0;          ///< flat: three times the least growth of memory in a quarter of the scenes
  double pace = 1.0;                  ///< flat: CPU time of the last tenth of the scenes / of the second tenth
  std::size_t parts = 0, resting = 0;
  std::string device;
  bool survived() const { return failures.empty(); }
};

/// The request of a case as YAML: what the solver is asked for, with model files relative to where it will lie.
std::string request_text(const Case& c, const std::string& solver);

/// Reads the YAML as the command line would (`directory`: where it lies) and runs it in this process.
Outcome run_here(const std::string& yaml, const std::string& directory, const Expect& expect);

/// Fails what grows over many scenes. CPU time (s) at the start and after each scene, bytes in use after each. Judged
/// by tenths, for scenes that are poured side by side are handed over in bursts; the first tenth warms up. Memory by
/// quarters: what grows with every scene grows in each of them, a buffer that is enlarged once does not.
void judge_growth(const std::vector<double>& cpu, const std::vector<double>& in_use, Outcome& outcome);

struct Limits {
  double cpu_s = 300.0;  ///< a case that takes longer hangs; no measure of speed
};

/// The same in a process of its own: a crash, a hang or a growing heap touches no other case.
Outcome run_apart(const std::string& yaml, const std::string& directory, const Expect& expect, const Limits& limits);

}  // namespace bin_scenes::stress
