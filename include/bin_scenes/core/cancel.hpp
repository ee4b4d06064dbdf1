/// Cancellation of long jobs. The caller of a job opens a CancelScope with a flag, and long loops of the job test the
/// flag that belongs to their thread. Jobs that use further threads pass the flag on to them (core/in_parallel.hpp).
/// Cancellation never changes a result: a job either completes or ends with Error(cancelled).
#pragma once

#include <atomic>

namespace bin_scenes {

/// While a CancelScope exists, the work of its thread is cancelled as soon as `*flag` is true. Scopes may be nested; a
/// scope without a flag (null) keeps the flag of the enclosing scope.
class CancelScope {
 public:
  explicit CancelScope(const std::atomic<bool>* flag);
  ~CancelScope();
  CancelScope(const CancelScope&) = delete;
  CancelScope& operator=(const CancelScope&) = delete;

 private:
  const std::atomic<bool>* outer_;
};

/// Returns the flag of the innermost scope of this thread, or null if the work of this thread cannot be cancelled.
const std::atomic<bool>* cancel_flag();

/// Whether the caller asked to cancel. The test takes about a nanosecond. Every loop whose length depends on the input
/// should make it at least 100 times a second.
bool cancelled();
/// Throws Error(cancelled) if the caller asked to cancel. Call it only where an exception leaves no half-made data
/// behind.
void stop_if_cancelled();

}  // namespace bin_scenes
