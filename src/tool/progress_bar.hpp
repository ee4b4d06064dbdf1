/// One line on a terminal that says how far a job is; nothing anywhere else.
#pragma once

#include "bin_scenes/pour/pour.hpp"

#include <chrono>

namespace bin_scenes {

class ProgressBar {
 public:
  ProgressBar();  ///< on standard error, if that is a terminal
  ~ProgressBar();
  void show(const Progress& progress);
  void clear();  ///< before other text

 private:
  bool terminal_, shown_ = false;
  std::chrono::steady_clock::time_point last_;
};

}  // namespace bin_scenes
