/// The thread in which a Python Generator works. All of its jobs run in this thread, one at a time, because a GL
/// context belongs to the thread that made it; Python's own threads can continue meanwhile. This header does not depend
/// on Python.
#pragma once

#include "bin_scenes/generate/generator.hpp"

#include <sys/types.h>

#include <atomic>
#include <condition_variable>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace bin_scenes::python {

/// Asked 20 times a second while a call waits. What it throws cancels the job, and reaches the caller once that ended.
using Poll = std::function<void()>;

class Session {
 public:
  using Job = std::function<void(Session&)>;

  /// A child of fork() has no threads of its parent: there the session is left as it is, and all calls are refused.
  static std::shared_ptr<Session> open();

  /// Does a job and waits for its end. Throws what the job throws, and an input Error at `caller` ("Heap.settle") if
  /// the session is closed, or busy with another job.
  void run(const std::string& caller, const Job& job, const Poll& poll);
  /// Starts a job, which must not throw, and returns its number. Throws like run() if the session refuses it.
  std::size_t start(const std::string& caller, Job job);
  /// Until `until()` or the end of that job. Throws what poll throws, after the job was cancelled and has ended.
  void wait(std::size_t job, const std::function<bool()>& until, const Poll& poll);
  void cancel(std::size_t job);  ///< without waiting; mutex() is not held
  /// Cancels what is running, waits for its end, and lets go of generator and heaps. Twice is once.
  void close();
  void refuse_if_closed(const std::string& caller) const;
  /// A heap is destroyed in the session's thread, as soon as that is idle.
  void drop(const Heap* heap);

  // For jobs, in the session's thread.
  Generator& generator() { return *generator_; }
  RunHooks hooks() const;
  Heap* keep(Heap&& heap);  ///< until drop() or the end of the session

  /// Held while state that jobs share with callers is read or changed; changed() wakes those who wait().
  std::mutex& mutex() { return mutex_; }
  std::condition_variable& changed() { return changed_; }
  const std::atomic<bool>& cancelled() const { return cancel_; }

 private:
  Session();
  ~Session() { close(); }
  void work();
  Job next_job();                                            ///< empty at the end
  void refuse_if_unusable(const std::string& caller) const;  ///< mutex() is held

  const pid_t process_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::unique_ptr<Generator> generator_;
  std::map<const Heap*, std::unique_ptr<Heap>> heaps_;  ///< only the thread of the session uses them
  std::vector<const Heap*> dropped_;
  Job job_;
  std::size_t started_ = 0, ended_ = 0;  ///< number of the last job; they differ while it runs
  bool closed_ = false;
  std::atomic<bool> cancel_{false};
  std::thread thread_;
};

/// Closes all sessions of this process: before the interpreter ends, while the libraries that they use are there.
void close_sessions();

}  // namespace bin_scenes::python
