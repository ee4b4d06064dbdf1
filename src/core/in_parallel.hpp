/// Loops whose iterations run on all cores. Iterations must not depend on each other, so that the result is the same
/// with any number of threads. The cancellation flag of the caller is valid in all of them.
#pragma once

#include "bin_scenes/core/cancel.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <cstddef>

namespace bin_scenes {

/// Calls work(i) for each i < count, in any order. This thread runs no other tasks while it waits, because it may hold
/// the lock of a part for which they would wait. Throws Error(cancelled) between two iterations if the work of this
/// thread is cancelled.
template <class Work>
void in_parallel(std::size_t count, const Work& work) {
  const std::atomic<bool>* flag = cancel_flag();
  tbb::this_task_arena::isolate([&] {
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
      const CancelScope scope(flag);
      stop_if_cancelled();
      work(i);
    });
  });
}

}  // namespace bin_scenes
