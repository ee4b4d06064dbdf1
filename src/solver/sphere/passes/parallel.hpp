/// Runs the loops of a step in all threads. A thread that waits for the others does not begin work of another world,
/// because the worlds of a thread share scratch memory. A cancelled job ends its loops early.
#pragma once

#include "bin_scenes/core/cancel.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <cstddef>

namespace bin_scenes::sphere {

/// `work(i)` for each i below `count`. Isolated: a thread that waits here for the others must not begin another world's
/// step, which would take the same scratch memory.
template <class Work>
void for_each_in_parallel(std::size_t count, const Work& work) {
  tbb::this_task_arena::isolate([&] {
    tbb::parallel_for(std::size_t{0}, count, [&, flag = cancel_flag()](std::size_t i) {
      const CancelScope scope(flag);
      work(i);
    });
  });
}

}  // namespace bin_scenes::sphere
