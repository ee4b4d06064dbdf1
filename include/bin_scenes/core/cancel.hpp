/// Whether work is still wanted. Whoever starts work says how to tell, by a scope; loops that may run for long ask.
/// Work that is handed to other threads takes the question along (core/in_parallel.hpp).
#pragma once

#include <atomic>

namespace bin_scenes {

/// While it lives, the work of this thread is unwanted as soon as `*flag` is true. Scopes nest: an inner one without a
/// flag leaves the outer one's in force.
class CancelScope {
 public:
  explicit CancelScope(const std::atomic<bool>* flag);
  ~CancelScope();
  CancelScope(const CancelScope&) = delete;
  CancelScope& operator=(const CancelScope&) = delete;

 private:
  const std::atomic<bool>* outer_;
};

/// That of the innermost scope of this thread; null: nobody can cancel its work.
const std::atomic<bool>* cancel_flag();

/// Costs about a nanosecond: ask at least a hundred times a second, wherever a loop's length depends on the input.
bool cancelled();
/// Throws Error(cancelled). Only where unwinding leaves nothing half-made.
void stop_if_cancelled();

}  // namespace bin_scenes
