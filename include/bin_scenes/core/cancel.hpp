/// Cancellation. The caller of a long job opens a CancelScope with a flag; long loops of the job test the flag of their
/// thread. Jobs that use other threads pass the flag on to them (core/in_parallel.hpp).
#pragma once

#include <atomic>

namespace bin_scenes {

/// While it exists, the work of this thread is cancelled as soon as `*flag` is true. Scopes nest: one without a flag
/// keeps the flag of the outer scope.
class CancelScope {
 public:
  explicit CancelScope(const std::atomic<bool>* flag);
  ~CancelScope();
  CancelScope(const CancelScope&) = delete;
  CancelScope& operator=(const CancelScope&) = delete;

 private:
  const std::atomic<bool>* outer_;
};

/// The flag of the innermost scope of this thread; null: its work cannot be cancelled.
const std::atomic<bool>* cancel_flag();

/// Costs about a nanosecond. Call it at least 100 times a second in every loop whose length depends on the input.
bool cancelled();
/// Throws Error(cancelled). Call it only where an exception leaves no half-made data behind.
void stop_if_cancelled();

}  // namespace bin_scenes
