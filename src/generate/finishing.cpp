#include "generate/finishing.hpp"

#include "bin_scenes/core/cancel.hpp"

namespace bin_scenes {

Finishing::~Finishing() {
  tasks_.wait();
}

void Finishing::add(std::size_t place, Scene&& scene) {
  Entry& entry = *(entries_[place] = std::make_unique<Entry>());
  entry.result.scene = std::move(scene);
  const std::size_t parts = entry.result.scene.parts.size();
  waiting_ += parts;
  tasks_.run([this, &entry, parts, flag = cancel_flag()] {
    const CancelScope scope(flag);
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
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      ++free_;
    }
    freed_.notify_one();
    entry.finished = true;
    waiting_ -= parts;
  });
  if (waiting_ > most_parts_waiting) tasks_.wait();
}

void Finishing::hand_on_finished() {
  for (auto first = entries_.begin(); first != entries_.end() && first->first == next_ && first->second->finished;
       first = entries_.begin()) {
    const std::unique_ptr<Entry> entry = std::move(first->second);
    entries_.erase(first);
    ++next_;
    if (entry->failed) std::rethrow_exception(entry->failed);
    hand_on_(std::move(entry->result));
  }
}

void Finishing::wait() {
  tasks_.wait();
  hand_on_finished();
}

}  // namespace bin_scenes
