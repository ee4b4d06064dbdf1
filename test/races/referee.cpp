#include "races/referee.hpp"

#include <algorithm>

namespace bin_scenes::races {

namespace {

void take(const Releases& from, Releases& to) {
  for (const auto& [group, release] : from)
    if (to[group].epoch < release.epoch) to[group] = release;
}

}  // namespace

void Referee::begin_group(Word group, Word size) {
  group_ = group;
  size_ = size;
  epoch_ = 1;
  ++group_serial_;
  fences_.assign(size, 0);
  seen_.assign(size, 0);
  found_.assign(size, {});
  own_.assign(size, {});
  taken_over_.clear();
}

void Referee::barrier() {
  ++epoch_;
  seen_ = fences_;
  for (const Releases& own : own_) take(own, taken_over_);
}

void Referee::fence(Word lane) {
  ++fences_[lane];
  take(found_[lane], own_[lane]);
}

bool Referee::is_released(const Access& before, const Releases& releases, bool must_see) const {
  const auto release = releases.find(before.who / size_);
  return release != releases.end() && before.epoch < release->second.epoch &&
         (!must_see || release->second.seen[before.who % size_] > before.fence);
}

bool Referee::in_order(const Access& before, const Memory& memory, Word lane, bool must_see) {
  if (before.dispatch == 0) return true;
  const bool same_time = before.dispatch == stamp(memory);
  if (!same_time && memory.is_shared) return true;
  if (!same_time) {
    crossed_ = crossed_ || before.dispatch + 1 == dispatch_;
    return before.dispatch < open_;
  }
  if (before.who == who(lane)) return true;
  if (before.who / size_ == group_)
    return before.epoch < epoch_ && (memory.is_shared || !must_see || seen_[before.who % size_] > before.fence);
  return is_released(before, taken_over_, must_see) || is_released(before, own_[lane], must_see);
}

void Referee::set(Access& access, const Memory& memory, Word lane, Word line) {
  access = {stamp(memory), who(lane), epoch_, fences_[lane], line};
}

/// In place of one that is in order with this one; a third of those that are not adds nothing.
void Referee::note(std::array<Access, 2>& accesses, const Memory& memory, Word lane, Word line) {
  for (Access& access : accesses)
    if (access.dispatch == stamp(memory) && access.who == who(lane)) return set(access, memory, lane, line);
  const bool crossed = crossed_;
  for (Access& access : accesses)
    if (in_order(access, memory, lane, true)) {
      set(access, memory, lane, line);
      break;
    }
  crossed_ = crossed;
}

bool Referee::is_outside(const Memory& memory, Word at, Word line) {
  if (at < memory.words.size()) return false;
  report("outside of its buffer", memory.name, line, line);
  return true;
}

Word Referee::read(Memory& memory, Word at, Word lane, Word line) {
  if (is_outside(memory, at, line)) return 0;
  if (memory.marks.empty()) return memory.words[at];
  Marks& marks = memory.marks[at];
  const Access& written = marks.written;
  const bool here = written.dispatch == stamp(memory);
  if (!in_order(written, memory, lane, true) || (marks.by_several && here && written.epoch == epoch_))
    report("read while written", memory.name, written.line, line);
  else if (here && written.who != who(lane) && !memory.coherent)
    report("read of what another wrote, not coherent", memory.name, written.line, line);
  bool touched = here;
  for (const Access& atomic : marks.atomic) {
    touched = touched || atomic.dispatch == stamp(memory);
    if (!in_order(atomic, memory, lane, true))
      report("read while changed by an atomic", memory.name, atomic.line, line);
  }
  if (memory.is_shared && !touched) report("read before it is written", memory.name, line, line);
  note(marks.read, memory, lane, line);
  return memory.words[at];
}

void Referee::write(Memory& memory, Word at, Word value, Word lane, Word line) {
  if (is_outside(memory, at, line)) return;
  if (!memory.marks.empty()) {
    Marks& marks = memory.marks[at];
    const bool same = marks.written.dispatch == stamp(memory) && memory.words[at] == value;
    const bool crossed = crossed_, after = in_order(marks.written, memory, lane, true);
    if (same) crossed_ = crossed;
    if (!after && !same) report("written by two", memory.name, marks.written.line, line);
    marks.by_several = !after && same;
    for (const Access& atomic : marks.atomic)
      if (!in_order(atomic, memory, lane, true))
        report("written while changed by an atomic", memory.name, atomic.line, line);
    for (const Access& read : marks.read)
      if (!in_order(read, memory, lane, false)) report("written while read", memory.name, read.line, line);
    set(marks.written, memory, lane, line);
  }
  memory.words[at] = value;
}

Word& Referee::atomic(Memory& memory, Word at, Word lane, Word line) {
  if (is_outside(memory, at, line)) return nowhere_;
  if (memory.marks.empty()) return memory.words[at];
  Marks& marks = memory.marks[at];
  if (!memory.is_shared) exchange_locks(memory, at, lane);
  if (!in_order(marks.written, memory, lane, true))
    report("changed by an atomic while written", memory.name, marks.written.line, line);
  for (const Access& read : marks.read)
    if (!in_order(read, memory, lane, false)) report("changed by an atomic while read", memory.name, read.line, line);
  for (const Access& atomic : marks.atomic)  // only of dispatches: among themselves they are in order
    if (atomic.dispatch != stamp(memory) && !in_order(atomic, memory, lane, true))
      report("changed by atomics of two dispatches", memory.name, atomic.line, line);
  note(marks.atomic, memory, lane, line);
  return memory.words[at];
}

/// Behind a fence an atomic releases what the group did before; what others have released there, it takes over with its
/// next fence.
void Referee::exchange_locks(const Memory& memory, Word at, Word lane) {
  const auto key = std::make_pair(&memory, at);
  const auto lock = locks_.find(key);
  if (lock != locks_.end()) take(lock->second, found_[lane]);
  if (fences_[lane] == 0) return;
  Releases& released = locks_[key];
  take(taken_over_, released);
  take({{group_, {epoch_, seen_}}}, released);
}

void Referee::read_arguments(const Memory& memory, Word at) {
  if (at >= memory.marks.size()) return;
  const Marks& marks = memory.marks[at];
  for (const Access& change : {marks.written, marks.atomic[0], marks.atomic[1]}) {
    if (change.dispatch == dispatch_ && dispatch_ != 0) arguments_crossed_ = true;
    if (change.dispatch >= arguments_open_)
      report("taken as number of groups while written", memory.name, change.line, 0);
  }
}

}  // namespace bin_scenes::races
