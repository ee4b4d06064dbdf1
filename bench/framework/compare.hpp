/// Which rows of two result files moved beyond noise.
#pragma once

#include "framework/table.hpp"

#include <string>
#include <vector>

namespace bin_scenes::bench {

struct Move {
  std::string benchmark, key, column;
  std::string before, after;  ///< with spread
  double change = 0.0;        ///< (after - before) / |before|; NaN where that makes no sense
};

struct Comparison {
  std::size_t rows = 0;    ///< found in both
  std::size_t values = 0;  ///< compared
  std::vector<Move> moved;
  std::vector<std::string> only_before, only_after;  ///< "benchmark: key" of rows found on one side
  std::vector<std::string> notes;                    ///< other device, other commit
};

/// A measure has moved if the medians differ by more than half of both ranges together and by more than `floor` of the
/// larger one. One that was sampled once has no spread of its own; a quarter of its value stands for it. An exact
/// column has moved if its text differs.
Comparison compare(const Table& before, const Table& after, double floor = 0.03);

/// Two CSV files, or two folders of them (files of the same name are compared). Throws an input Error if there is
/// nothing to compare.
Comparison compare_paths(const std::string& before, const std::string& after, double floor = 0.03);

std::string to_text(const Comparison& comparison);

}  // namespace bin_scenes::bench
