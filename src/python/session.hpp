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

/// A wait calls this function 20 times a second. If it throws, the job is cancelled, and the caller gets the exception.
using Poll = std::function<void()>;

class Session {
 public:
  using Job = std::function<void(Session&)>;

  /// Starts a session. In a child process of fork(), which has no threads of its parent, all calls are refused.
  static std::shared_ptr<Session> open();

  /// Does a job and waits for its end. Throws what the job throws, and an input Error at `caller` ("Heap.settle") if
  /// the session is closed, or busy with another job.
  void run(const std::string& caller, const Job& job, const Poll& poll);
  /// Starts a job, which must not throw, and returns its number. Throws like run() if the session refuses it.
  std::size_t start(const std::string& caller, Job job);
  /// Waits until until() is true or the job ends. If poll() throws, cancels the job, waits for its end, and rethrows.
  void wait(std::size_t job, const std::function<bool()>& until, const Poll& poll);
  void cancel(std::size_t job);  ///< does not wait; the caller must not hold mutex()
  /// Cancels the running job, waits for its end, and destroys generator and heaps. A second call does nothing.
  void close();
  void refuse_if_closed(const std::string& caller) const;
  /// Destroys a heap in the thread of the session, when no job runs.
  void drop(const Heap* heap);

  // Functions for jobs, to be called in the thread of the session.
  Generator& generator() { return *generator_; }
  RunHooks hooks() const;
  Heap* keep(Heap&& heap);  ///< keeps it until drop() or the end of the session

  /// To be locked while state that jobs and callers share is used; notify changed() to wake callers in wait().
  std::mutex& mutex() { return mutex_; }
  std::condition_variable& changed() { return changed_; }
  const std::atomic<bool>& cancelled() const { return cancel_; }

 private:
  Session();
  ~Session() { close(); }
  void work();
  Job next_job();                                            ///< returns an empty function at the end
  void refuse_if_unusable(const std::string& caller) const;  ///< mutex() must be held

  const pid_t process_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::unique_ptr<Generator> generator_;
  std::map<const Heap*, std::unique_ptr<Heap>> heaps_;  ///< only the thread of the session uses them
  std::vector<const Heap*> dropped_;
  Job job_;
  std::size_t started_ = 0, ended_ = 0;  ///< number of the last job that was started, or that ended
  bool closed_ = false;
  std::atomic<bool> cancel_{false};
  std::thread thread_;
};

/// Closes all sessions of this process, before the interpreter ends and unloads the libraries that they use.
void close_sessions();

}  // namespace bin_scenes::python
