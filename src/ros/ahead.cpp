#include "ahead.hpp"

#include "bin_scenes/core/cancel.hpp"
#include "bin_scenes/core/error.hpp"

#include <chrono>
#include <utility>

namespace bin_scenes {

Ahead::Ahead(int depth, Publication& publication)
    : depth_(static_cast<std::size_t>(depth)), publication_(publication), thread_(&Ahead::run, this) {}

Ahead::~Ahead() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = unwanted_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void Ahead::follow(const Request& request, std::size_t index) {
  const std::lock_guard<std::mutex> lock(mutex_);
  // A pick or a scene that was taken from here changes nothing about what comes next.
  if (following_ && request_.text_sha256 == request.text_sha256 && index + 1 + ready_.size() == next_) return;
  ready_.clear();
  failed_ = nullptr;
  request_ = request;
  next_ = index + 1;
  following_ = true;
  unwanted_ = true;  // what is being made; reset as the next one begins
  changed_.notify_all();
}

MadeScene Ahead::take(const RunHooks& hooks) {
  std::unique_lock<std::mutex> lock(mutex_);
  while (ready_.empty()) {
    if (failed_) std::rethrow_exception(std::exchange(failed_, nullptr));
    if (hooks.cancel && *hooks.cancel) throw Error(ErrorKind::cancelled, "cancelled", "next_scene", "ask again");
    changed_.wait_for(lock, std::chrono::milliseconds(50));
  }
  MadeScene made = std::move(ready_.front());
  ready_.pop_front();
  changed_.notify_all();
  return made;
}

std::size_t Ahead::ready() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return ready_.size();
}

void Ahead::run() {
  SceneMaker maker;
  for (;;) {
    Request request;
    {
      std::unique_lock<std::mutex> lock(mutex_);
      changed_.wait(lock, [&] { return stop_ || (following_ && !failed_ && ready_.size() < depth_); });
      if (stop_) return;
      unwanted_ = false;
      request = request_;
      request.first = next_;
    }
    std::exception_ptr failed;
    MadeScene made;
    try {
      RunHooks hooks;
      hooks.cancel = &unwanted_;
      const CancelScope scope(&unwanted_);
      made = maker.pour(request, hooks);
      publication_.render(made, false, hooks);
    } catch (...) {
      failed = std::current_exception();
    }
    const std::lock_guard<std::mutex> lock(mutex_);
    if (unwanted_) continue;  // made for what is followed no more
    if (failed) {
      failed_ = failed;
    } else {
      ready_.push_back(std::move(made));
    }
    ++next_;
    changed_.notify_all();
  }
}

}  // namespace bin_scenes
