#include "judging.hpp"

#include "bin_scenes/core/cancel.hpp"

namespace bin_scenes {

Judging::~Judging() {
  tasks_.wait();
}

void Judging::add(std::size_t place, Scene&& scene) {
  Entry& entry = *(entries_[place] = std::make_unique<Entry>());
  entry.scene = std::move(scene);
  const std::size_t parts = entry.scene.parts.size();
  waiting_ += parts;
  tasks_.run([this, &entry, parts, flag = cancel_flag()] {
    const CancelScope scope(flag);
    try {
      stop_if_cancelled();
      judge_(entry.scene);
    } catch (...) {
      entry.failed = std::current_exception();
    }
    entry.judged = true;
    waiting_ -= parts;
  });
  if (waiting_ > most_parts_waiting) tasks_.wait();
}

void Judging::hand_on_judged() {
  for (auto first = entries_.begin(); first != entries_.end() && first->first == next_ && first->second->judged;
       first = entries_.begin()) {
    const std::unique_ptr<Entry> entry = std::move(first->second);
    entries_.erase(first);
    ++next_;
    if (entry->failed) std::rethrow_exception(entry->failed);
    hand_on_(std::move(entry->scene));
  }
}

void Judging::finish() {
  tasks_.wait();
  hand_on_judged();
}

}  // namespace bin_scenes
