/// Runs a function in a forked child, so that a crash or an endless loop inside a third-party reader costs an error
/// message instead of the process. Seen with assimp 5.2.5: a damaged COLLADA file crashed it.
#pragma once

#include <functional>
#include <string>

namespace bin_scenes {

struct Contained {
  bool finished = false;
  std::string output;   ///< what the function returned
  std::string failure;  ///< if not finished: "crashed (Segmentation fault)", "did not finish within 60 s"
};

/// `work` must not throw and must need nothing but memory and files: no other thread of the parent lives on in the
/// child. Throws an environment Error if no process can be started.
Contained run_contained(const std::function<std::string()>& work, unsigned cpu_seconds);

}  // namespace bin_scenes
