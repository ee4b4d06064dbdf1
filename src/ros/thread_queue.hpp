/// A thread with its own callback queue: callbacks of roscpp and posted functions run in it one after the other.
/// Objects that are used in this thread only need no locks.
#pragma once

#include <ros/callback_queue.h>
#include <boost/make_shared.hpp>

#include <atomic>
#include <functional>
#include <future>
#include <memory>
#include <thread>

namespace bin_scenes {

class ThreadQueue {
 public:
  ThreadQueue() : thread_([this] { spin(); }) {}
  ~ThreadQueue() { stop(); }
  ThreadQueue(const ThreadQueue&) = delete;
  ThreadQueue& operator=(const ThreadQueue&) = delete;

  ros::CallbackQueue* queue() { return &queue_; }
  void post(std::function<void()> work) { queue_.addCallback(boost::make_shared<Task>(std::move(work))); }
  /// Runs `work` in the thread, waits for it, and returns its result or rethrows. Not to be called from this thread.
  template <class Work>
  auto call(Work work) {
    const auto task = std::make_shared<std::packaged_task<decltype(work())()>>(std::move(work));
    auto result = task->get_future();
    post([task] { (*task)(); });
    return result.get();
  }
  /// Ends the thread: waits for the function that is running, and drops the functions that are waiting.
  void stop() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
    queue_.disable();
    queue_.clear();
  }

 private:
  class Task : public ros::CallbackInterface {
   public:
    explicit Task(std::function<void()> work) : work_(std::move(work)) {}
    CallResult call() override {
      work_();
      return Success;
    }

   private:
    std::function<void()> work_;
  };

  void spin() {
    while (!stop_) queue_.callAvailable(ros::WallDuration(0.05));
  }

  ros::CallbackQueue queue_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace bin_scenes
