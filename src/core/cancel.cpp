#include "bin_scenes/core/cancel.hpp"

#include "bin_scenes/core/error.hpp"

namespace bin_scenes {

namespace {
thread_local const std::atomic<bool>* innermost = nullptr;
}

CancelScope::CancelScope(const std::atomic<bool>* flag) : outer_(innermost) {
  if (flag) innermost = flag;
}
CancelScope::~CancelScope() {
  innermost = outer_;
}

const std::atomic<bool>* cancel_flag() {
  return innermost;
}

bool cancelled() {
  return innermost && innermost->load(std::memory_order_relaxed);
}

void stop_if_cancelled() {
  if (cancelled()) throw Error(ErrorKind::cancelled, "cancelled", "", "");
}

}  // namespace bin_scenes
