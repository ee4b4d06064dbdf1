#include "generate/finishing.hpp"

namespace bin_scenes {

namespace {

/// Scenes that may wait to be finished. On one core nobody does it beside the thread that pours: it then does it
/// itself.
constexpr std::size_t most_waiting = 256;

}  // namespace

Finishing::~Finishing() {
  tasks_.wait();
}

void Finishing::add(std::size_t place, Scene&& scene) {
  Entry& entry = *(entries_[place] = std::make_unique<Entry>());
  entry.result.scene = std::move(scene);
  ++waiting_;
  tasks_.run([this, &entry] {
    {
      std::unique_lock<std::mutex> lock(mutex_);
      freed_.wait(lock, [&] { return free_ > 0; });  // those before it need nothing from it: they come to an end
      --free_;
    }
    try {
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
    --waiting_;
  });
  if (waiting_ > most_waiting) tasks_.wait();
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
