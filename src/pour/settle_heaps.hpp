/// Settles several heaps with one solver, in which each heap is a world. The heaps are stepped together; when one is
/// finished, the next one takes its place, so that a GPU always has enough work. What a heap does at each stage is
/// decided in heap_core.hpp.
#pragma once

#include "pour/heap_core.hpp"

#include <functional>

namespace bin_scenes {

/// The functions that provide heaps and receive them, by number from 0 on. Both are called from the calling thread.
struct HeapSource {
  std::size_t count = 0;
  /// Returns the next heap; called in order when there is room for one more.
  std::function<HeapCore&(std::size_t number)> next;
  /// Called when a heap is at rest or out of time; it is not used afterwards.
  std::function<void(std::size_t number)> over;
};

/// Advances Solver::worlds_at_once() heaps at a time. A finished heap leaves, and the next one takes its place. The
/// result of a heap does not depend on the others. Throws Error(cancelled) between two steps, after which each heap can
/// be continued.
void settle_heaps(Solver& solver, const HeapSource& source, const RunHooks& hooks);

}  // namespace bin_scenes
