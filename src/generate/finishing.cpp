#include "generate/finishing.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/core/cancel.hpp"

#include <tbb/task_arena.h>

#include <algorithm>

namespace bin_scenes {

std::size_t scenes_waiting(std::size_t at_once) {
  const auto cores = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
  BIN_SCENES_ASSERT(cores >= 1);
  return std::clamp<std::size_t>(at_once, 2, 2 * cores);
}

Finishing::~Finishing() {
  tasks_.wait();
}

void Finishing::finish(Entry& entry) {
  if (entry.begun.exchange(true)) return;
  const std::size_t parts = entry.result.scene.parts.size();
  {
    std::unique_lock<std::mutex> lock(mutex_);
    freed_.wait(lock, [&] { return free_ > 0; });  // those before it need nothing from it: they come to an end
    --free_;
  }
  try {
    stop_if_cancelled();
    finish_(entry.result);
  } catch (...) {
    entry.failed = std::current_exception();
  }
  BIN_SCENES_ASSERT(waiting_ >= parts);
  waiting_ -= parts;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++free_;
    entry.finished = true;
  }
  freed_.notify_all();
}

void Finishing::wait_for_first() {
  BIN_SCENES_ASSERT(!entries_.empty());
  const std::shared_ptr<Entry> entry = entries_.begin()->second;
  finish(*entry);
  std::unique_lock<std::mutex> lock(mutex_);
  freed_.wait(lock, [&] { return entry->finished.load(); });
}

void Finishing::add(std::size_t place, Scene&& scene) {
  BIN_SCENES_ASSERT(place >= next_ && entries_.count(place) == 0);  // a scene is added once, and before it is handed on
  const auto entry = entries_[place] = std::make_shared<Entry>();
  entry->result.scene = std::move(scene);
  waiting_ += entry->result.scene.parts.size();
  tasks_.run([this, entry, flag = cancel_flag()] {
    const CancelScope scope(flag);
    finish(*entry);
  });
  if (waiting_ > most_parts_waiting) tasks_.wait();
  while (entries_.size() > most_waiting_ && entries_.begin()->first == next_) {
    wait_for_first();
    hand_on_finished();
  }
}

void Finishing::hand_on_finished() {
  for (auto first = entries_.begin(); first != entries_.end() && first->first == next_ && first->second->finished;
       first = entries_.begin()) {
    const std::shared_ptr<Entry> entry = std::move(first->second);
    entries_.erase(first);
    ++next_;
    if (entry->failed) std::rethrow_exception(entry->failed);
    hand_on_(std::move(entry->result));
  }
}

void Finishing::wait() {
  while (!entries_.empty()) {
    wait_for_first();
    hand_on_finished();
  }
}

}  // namespace bin_scenes
