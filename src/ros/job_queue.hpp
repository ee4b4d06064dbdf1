/// Jobs that change the content of the bin. They run one after the other in one thread, and each reports how it ended.
///
///     action goals ─┐
///     service calls ├──► waiting ──► running ──► committed ──► ended      answer() is called once, at the end
///     first scene  ─┘       └───────────┴── cancel() ───────────┘
///
/// A cancelled job is answered at once; the thread leaves its work within a fraction of a second after that. What it
/// has made by then is dropped, because only a committed job may publish.
#pragma once

#include "bin_scenes/pour/pour.hpp"
#include "messages.hpp"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace bin_scenes {

/// The outcome of a job, as action and services report it.
struct Outcome {
  bool success = false;
  std::int32_t error_code = bin_scenes_msgs::ErrorCode::NONE;
  std::string message;
  bin_scenes_msgs::Scene scene;
};

/// Returns the outcome of a job that has thrown an exception. To be called in the handler of the exception.
Outcome outcome_of_exception();

class Job {
 public:
  using Work = std::function<Outcome(Job&)>;
  using Answer = std::function<void(const Outcome&)>;

  /// `work` runs in the thread of the queue. `answer` is called once, in that thread or in the one that calls cancel().
  Job(std::string name, Work work, Answer answer);

  const std::string& name() const { return name_; }
  bool ended() const;
  /// Ends the job as cancelled, with `reason`. Returns false if the job has ended or is committed already.
  bool cancel(const std::string& reason);

  // Functions for `work`.
  /// Returns hooks that store the progress of the job in its state, and that stop the work when the job is cancelled.
  RunHooks hooks();
  /// After this call, the job cannot be cancelled. Throws Error(cancelled) if it was cancelled before.
  void commit();

  struct State {
    Progress progress;       ///< progress; its phase is "queued" until the job runs
    double running_s = 0.0;  ///< wall-clock time since the job began (s)
  };
  State state() const;

 private:
  friend class JobQueue;
  void run();
  bool end();  ///< marks the job as ended; returns false if it was already

  const std::string name_;
  Work work_;
  Answer answer_;
  std::atomic<bool> unwanted_{false};  ///< whether the job was cancelled
  mutable std::mutex mutex_;
  enum class Stage { waiting, running, committed, ended } stage_ = Stage::waiting;
  Progress progress_;
  std::chrono::steady_clock::time_point begun_;
};

class JobQueue {
 public:
  /// `at_end` is called in the thread of the jobs after the last job, so that OpenGL objects are destroyed in the
  /// thread that made them.
  JobQueue(std::size_t most_waiting, std::function<void()> at_end);
  /// Cancels all jobs.
  ~JobQueue();
  JobQueue(const JobQueue&) = delete;
  JobQueue& operator=(const JobQueue&) = delete;

  /// Throws an environment Error if too many jobs wait already.
  void add(std::shared_ptr<Job> job);
  /// Cancels all jobs that wait or run, and returns their number.
  std::size_t cancel_all(const std::string& reason);
  std::size_t size() const;              ///< number of jobs that wait or run
  std::shared_ptr<Job> running() const;  ///< the running job; null: none

 private:
  void run();

  const std::size_t most_waiting_;
  const std::function<void()> at_end_;
  mutable std::mutex mutex_;
  std::condition_variable added_;
  std::deque<std::shared_ptr<Job>> waiting_;
  std::shared_ptr<Job> running_;
  bool stop_ = false;
  std::thread thread_;
};

}  // namespace bin_scenes
