/// Hands jobs to the thread of a session and waits for them, so that a signal or another thread can end the wait.
#include "session.hpp"

#include "bin_scenes/core/error.hpp"

#include <unistd.h>

#include <chrono>
#include <set>
#include <utility>
#include <vector>

namespace bin_scenes::python {

namespace {

constexpr std::chrono::milliseconds poll_interval(50);

/// Of this process, to close them at its end.
struct Registry {
  std::mutex mutex;
  std::set<Session*> sessions;
  std::atomic<pid_t> used_in{0};  ///< process of the first session
};
Registry& registry() {
  static auto* const all = new Registry;  // outlives whoever ends last
  return *all;
}

}  // namespace

Session::Session() : process_(getpid()), thread_(&Session::work, this) {}

std::shared_ptr<Session> Session::open() {
  Registry& all = registry();
  if (all.used_in != 0 && all.used_in != getpid()) {
    throw input_error("this process was forked from one that has made scenes; the threads that made them are not here",
                      "Generator", "start processes by 'spawn', or make the first Generator after the fork");
  }
  // Threads and locks of a forked process are not there any more: nothing may be destroyed.
  std::shared_ptr<Session> session(new Session, [](Session* own) {
    if (own->process_ != getpid()) return;
    {
      Registry& all = registry();
      const std::lock_guard<std::mutex> lock(all.mutex);
      all.sessions.erase(own);
    }
    delete own;
  });
  const std::lock_guard<std::mutex> lock(all.mutex);
  all.sessions.insert(session.get());
  all.used_in = getpid();
  return session;
}

void close_sessions() {
  Registry& all = registry();
  if (all.used_in != getpid()) return;
  const std::lock_guard<std::mutex> lock(all.mutex);
  for (Session* session : all.sessions) session->close();
}

void Session::refuse_if_closed(const std::string& caller) const {
  if (process_ != getpid()) {
    throw input_error("the generator belongs to another process", caller,
                      "make a Generator in each process, after it was started");
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  if (closed_) throw input_error("the generator is closed", caller, "make another Generator");
}

void Session::refuse_if_unusable(const std::string& caller) const {
  if (closed_) throw input_error("the generator is closed", caller, "make another Generator");
  if (started_ != ended_) {
    throw input_error("the generator is in use by another thread or loop", caller,
                      "wait for its end, close the scenes of that loop, or make a Generator for each thread");
  }
}

std::size_t Session::start(const std::string& caller, Job job) {
  refuse_if_closed(caller);  // before a lock of another process is touched
  const std::lock_guard<std::mutex> lock(mutex_);
  refuse_if_unusable(caller);
  job_ = std::move(job);
  cancel_ = false;
  changed_.notify_all();
  return ++started_;
}

void Session::run(const std::string& caller, const Job& job, const Poll& poll) {
  std::exception_ptr failed;
  const std::size_t number = start(caller, [&](Session& session) {
    try {
      job(session);
    } catch (...) {
      failed = std::current_exception();
    }
  });
  wait(
      number, [] { return false; }, poll);
  if (failed) {
    refuse_if_closed(caller);  // close() is why it was cancelled
    std::rethrow_exception(failed);
  }
}

void Session::wait(std::size_t job, const std::function<bool()>& until, const Poll& poll) {
  std::exception_ptr interrupted;
  std::unique_lock<std::mutex> lock(mutex_);
  while (ended_ < job && (interrupted || !until())) {
    if (changed_.wait_for(lock, poll_interval) != std::cv_status::timeout || interrupted) continue;
    lock.unlock();
    try {
      poll();
    } catch (...) {
      interrupted = std::current_exception();
      cancel(job);
    }
    lock.lock();
  }
  if (interrupted) std::rethrow_exception(interrupted);
}

void Session::cancel(std::size_t job) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (ended_ >= job) return;
  cancel_ = true;
  changed_.notify_all();
}

void Session::close() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    closed_ = cancel_ = true;
    changed_.notify_all();
  }
  static std::mutex joining;  // two threads may close at once
  const std::lock_guard<std::mutex> lock(joining);
  if (thread_.joinable()) thread_.join();
}

RunHooks Session::hooks() const {
  RunHooks hooks;
  hooks.cancel = &cancel_;
  return hooks;
}

Heap* Session::keep(Heap&& heap) {
  auto kept = std::make_unique<Heap>(std::move(heap));
  Heap* const address = kept.get();
  heaps_[address] = std::move(kept);
  return address;
}

void Session::drop(const Heap* heap) {
  if (process_ != getpid()) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  dropped_.push_back(heap);
  changed_.notify_all();
}

Session::Job Session::next_job() {
  std::unique_lock<std::mutex> lock(mutex_);
  for (;;) {
    changed_.wait(lock, [&] { return closed_ || started_ != ended_ || !dropped_.empty(); });
    for (const Heap* heap : std::exchange(dropped_, {})) heaps_.erase(heap);
    if (started_ != ended_) return std::exchange(job_, {});
    if (closed_) return {};
  }
}

void Session::work() {
  generator_ = std::make_unique<Generator>();
  while (Job job = next_job()) {
    job(*this);
    job = {};  // what it holds may be large
    const std::lock_guard<std::mutex> lock(mutex_);
    ++ended_;
    changed_.notify_all();
  }
  heaps_.clear();
  generator_.reset();
}

}  // namespace bin_scenes::python
