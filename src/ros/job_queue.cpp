/// One thread takes jobs in order; states change under one lock. A job's answer is given exactly once, whoever ends it.
#include "job_queue.hpp"

#include "bin_scenes/core/cancel.hpp"
#include "bin_scenes/core/error.hpp"

#include <algorithm>
#include <new>

namespace bin_scenes {

namespace {

using Code = bin_scenes_msgs::ErrorCode;

std::int32_t code_of(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::input:
      return Code::INPUT;
    case ErrorKind::environment:
      return Code::ENVIRONMENT;
    case ErrorKind::cancelled:
      return Code::CANCELLED;
  }
  return Code::INTERNAL;
}

Outcome failure(std::int32_t code, const std::string& message) {
  Outcome outcome;
  outcome.error_code = code;
  outcome.message = message;
  return outcome;
}

}  // namespace

Outcome outcome_of_exception() {
  try {
    throw;
  } catch (const Error& error) {
    return failure(code_of(error.kind()), error.what());
  } catch (const std::bad_alloc&) {
    return failure(Code::ENVIRONMENT, "out of memory (ask for fewer parts or pixels)");
  } catch (const std::exception& error) {
    return failure(Code::INTERNAL, std::string("a defect of bin_scenes: ") + error.what());
  }
}

Job::Job(std::string name, Work work, Answer answer)
    : name_(std::move(name)), work_(std::move(work)), answer_(std::move(answer)) {
  progress_.phase = "queued";
}

bool Job::ended() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return stage_ == Stage::ended;
}

bool Job::cancel(const std::string& reason) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (stage_ == Stage::committed || stage_ == Stage::ended) return false;
    stage_ = Stage::ended;
    unwanted_ = true;
  }
  answer_(failure(Code::CANCELLED, reason));
  return true;
}

RunHooks Job::hooks() {
  RunHooks hooks;
  hooks.cancel = &unwanted_;
  hooks.progress = [this](const Progress& progress) {
    const std::lock_guard<std::mutex> lock(mutex_);
    const double fraction = std::max(progress_.fraction, progress.fraction);
    progress_ = progress;
    progress_.fraction = fraction;
  };
  return hooks;
}

void Job::commit() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (stage_ == Stage::ended) throw Error(ErrorKind::cancelled, "cancelled", name_, "ask again");
  stage_ = Stage::committed;
}

Job::State Job::state() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  State state{progress_, 0.0};
  if (stage_ != Stage::waiting) {
    state.running_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun_).count();
  }
  return state;
}

void Job::run() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (stage_ == Stage::ended) return;
    stage_ = Stage::running;
    begun_ = std::chrono::steady_clock::now();
  }
  Outcome outcome;
  try {
    const CancelScope scope(&unwanted_);
    outcome = work_(*this);
  } catch (...) {
    outcome = outcome_of_exception();
  }
  if (end()) answer_(outcome);
}

bool Job::end() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (stage_ == Stage::ended) return false;
  stage_ = Stage::ended;
  return true;
}

JobQueue::JobQueue(std::size_t most_waiting, std::function<void()> at_end)
    : most_waiting_(most_waiting), at_end_(std::move(at_end)), thread_(&JobQueue::run, this) {}

JobQueue::~JobQueue() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  cancel_all("the node ends");
  added_.notify_all();
  thread_.join();
}

void JobQueue::add(std::shared_ptr<Job> job) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto ended = [](const std::shared_ptr<Job>& waiting) { return waiting->ended(); };
    waiting_.erase(std::remove_if(waiting_.begin(), waiting_.end(), ended), waiting_.end());
    if (waiting_.size() >= most_waiting_) {
      throw environment_error(std::to_string(waiting_.size()) + " jobs wait already", "the queue of the node",
                              "wait for earlier ones, cancel them, or raise ~queue_size");
    }
    waiting_.push_back(std::move(job));
  }
  added_.notify_all();
}

std::size_t JobQueue::cancel_all(const std::string& reason) {
  std::vector<std::shared_ptr<Job>> jobs;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    jobs.assign(waiting_.begin(), waiting_.end());
    if (running_) jobs.push_back(running_);
  }
  // Not under the lock: an answer may take that of whoever asks, who may be adding a job.
  return static_cast<std::size_t>(
      std::count_if(jobs.begin(), jobs.end(), [&](const auto& job) { return job->cancel(reason); }));
}

std::size_t JobQueue::size() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto open = [](const std::shared_ptr<Job>& job) { return !job->ended(); };
  return static_cast<std::size_t>(std::count_if(waiting_.begin(), waiting_.end(), open)) + (running_ ? 1 : 0);
}

std::shared_ptr<Job> JobQueue::running() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return running_;
}

void JobQueue::run() {
  for (;;) {
    std::unique_lock<std::mutex> lock(mutex_);
    running_.reset();
    added_.wait(lock, [&] { return stop_ || !waiting_.empty(); });
    if (stop_) {
      at_end_();
      return;
    }
    const std::shared_ptr<Job> job = running_ = waiting_.front();
    waiting_.pop_front();
    lock.unlock();
    job->run();
  }
}

}  // namespace bin_scenes
