#include "judging.hpp"

namespace bin_scenes {

namespace {

/// Scenes that may wait for a judge. On one core nobody judges beside the thread that pours: it then does it itself.
constexpr std::size_t most_waiting = 256;

}  // namespace

Judging::~Judging() {
  tasks_.wait();
}

void Judging::add(std::size_t place, Scene&& scene) {
  Entry& entry = *(entries_[place] = std::make_unique<Entry>());
  entry.scene = std::move(scene);
  ++waiting_;
  tasks_.run([this, &entry] {
    try {
      judge_(entry.scene);
    } catch (...) {
      entry.failed = std::current_exception();
    }
    entry.judged = true;
    --waiting_;
  });
  if (waiting_ > most_waiting) tasks_.wait();
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
