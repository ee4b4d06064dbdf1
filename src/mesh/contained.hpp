/// Runs a function in a forked child process, so that a crash or an endless loop in a third-party reader causes an
/// error message and does not end this process. The reason is assimp 5.2.5, which crashed on a damaged COLLADA file.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace bin_scenes {

struct Contained {
  bool finished = false;
  std::string output;   ///< the bytes that the function returned
  std::string failure;  ///< if not finished: "crashed (Segmentation fault)", "did not finish within 60 s"
};

struct ContainedLimits {
  unsigned cpu_seconds = 60;  ///< limit on processor time; unlike wall time, it does not depend on the machine's load
  std::size_t bytes = std::size_t{4} << 30;  ///< limit on memory in addition to the parent's
};

/// Runs `work` in a child process. `work` must throw nothing but std::bad_alloc and use nothing but memory and files,
/// because no other thread of the parent continues in the child. The child ends with the thread that waits for it, and
/// at once if the work of that thread is cancelled: Error(cancelled). Throws an environment Error if no process can be
/// started.
Contained run_contained(const std::function<std::string()>& work, const ContainedLimits& limits);

}  // namespace bin_scenes
