/// The commands of the command line, each from its parsed options to its exit code. They throw Error.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace bin_scenes {

/// Beside these, an Error's kind is the exit code: 2 input, 3 environment.
enum ExitCode { exit_done = 0, exit_set_apart = 1, exit_interrupted = 130 };  ///< 130: SIGINT or SIGTERM, as shells say

struct GenerateOptions {
  std::string request, out;
  std::optional<std::string> seed, scenes, first, solver, seconds;  ///< overrides, judged like --set
  std::vector<std::string> set;
  std::vector<std::string> formats = {"json"};
  std::string trace;        ///< CSV file; empty = none
  double trace_rate = 100;  ///< Hz of simulated time
  bool overwrite = false;
  bool verify = false;      ///< read every file of the scenes that are there
  bool verbose = false;
};
int generate(const GenerateOptions& options);

struct InspectOptions {
  std::string model, unit;
  std::string hulls;  ///< OBJ file for the convex hulls; empty = none
  bool json = false;
};
int inspect(const InspectOptions& options);

int doctor();

}  // namespace bin_scenes
