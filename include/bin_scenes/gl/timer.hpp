/// Device times of stages by pairs of timestamps (GL_TIME_ELAPSED returns 0 around compute on llvmpipe).
/// Results are fetched later, so that measuring does not stall.
#pragma once

#include "bin_scenes/core/profile.hpp"

#include <deque>
#include <string>
#include <vector>

namespace bin_scenes::gl {

class Timer {
 public:
  Timer() = default;
  ~Timer();
  Timer(const Timer&) = delete;
  Timer& operator=(const Timer&) = delete;

  /// Marks begin and end of a stage; stages do not nest. Also a debug group of that name.
  void begin(const std::string& stage);
  void end();

  /// Adds the stages that are finished, oldest first, to `profile`; with `wait` all of them.
  void collect(Profile& profile, bool wait = false);

 private:
  struct Pair {
    std::string stage;
    unsigned begin = 0, end = 0;
  };
  unsigned query();

  std::deque<Pair> open_;
  std::vector<unsigned> free_;
};

/// Times one scope.
class Stage {
 public:
  Stage(Timer& timer, const std::string& name) : timer_(timer) { timer_.begin(name); }
  ~Stage() { timer_.end(); }
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

 private:
  Timer& timer_;
};

}  // namespace bin_scenes::gl
