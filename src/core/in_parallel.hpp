/// Work that falls into pieces, on all cores.
#pragma once

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <cstddef>

namespace bin_scenes {

/// work(i) for every i below the count, in any order. Other tasks stay out of this thread meanwhile: it may hold the
/// lock of a part, for which they might wait.
template <class Work>
void in_parallel(std::size_t count, const Work& work) {
  tbb::this_task_arena::isolate([&] { tbb::parallel_for(std::size_t{0}, count, work); });
}

}  // namespace bin_scenes
