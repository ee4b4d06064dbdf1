/// Measures the time that stages take on the device, by pairs of timestamps; GL_TIME_ELAPSED would return 0 around
/// compute passes on llvmpipe. Results are fetched later, so that measuring does not make the host wait. The times are
/// added to a Profile.
#pragma once

#include "bin_scenes/core/profile.hpp"

#include <deque>
#include <string>
#include <vector>

namespace bin_scenes::gl {

/// Measures consecutive stages. Its queries belong to the context that was current at first use.
class Timer {
 public:
  Timer() = default;
  ~Timer();
  Timer(const Timer&) = delete;
  Timer& operator=(const Timer&) = delete;

  /// Mark the begin and the end of a stage; stages cannot be nested. A stage is also a debug group of that name.
  void begin(const std::string& stage);
  void end();

  /// Adds the stages that are finished to `profile`, oldest first. With `wait`, it waits for all stages.
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

/// Measures one scope as a stage.
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
