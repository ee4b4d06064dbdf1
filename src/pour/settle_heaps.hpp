/// Settles several heaps of one solver, which are stepped together until each of them is finished.
#pragma once

#include "pour/heap_core.hpp"

#include <functional>

namespace bin_scenes {

/// The functions that provide heaps and receive them, by number from 0 on. Both are called from the calling thread.
struct HeapSource {
  std::size_t count = 0;
  std::function<HeapCore&(std::size_t number)> next;  ///< asked for in order, when there is room for one more
  std::function<void(std::size_t number)> over;       ///< rests, or ran out of time; the heap is not touched any more
};

/// Steps Solver::worlds_at_once() heaps at a time; one that is over leaves, and the next takes its place. A heap's
/// result does not depend on what runs beside it. Throws Error(cancelled) between two steps, from which each heap could
/// go on.
void settle_heaps(Solver& solver, const HeapSource& source, const RunHooks& hooks);

}  // namespace bin_scenes
