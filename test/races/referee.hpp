/// Memory that knows who read and wrote each of its words, and finds what two invocations do to one in no order.
///
/// Two accesses of which one writes are in order if
///   - one invocation makes both,
///   - both are of one group with a barrier() between them, and what was written in a buffer is behind a
///     memoryBarrierBuffer() before that barrier,
///   - they are of two dispatches with a barrier of the host between them,
///   - or of two groups, and the first has released a lock that the second has taken since.
/// Else they race. That several write the same value is allowed, and atomics do not race among themselves.
#pragma once

#include "races/module.hpp"

#include <array>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <vector>

namespace bin_scenes::races {

/// The last time that a word was touched in some way.
struct Access {
  Word dispatch = 0, who = 0, epoch = 0, fence = 0, line = 0;  ///< dispatch 0: never
};

struct Marks {
  Access written;
  std::array<Access, 2> atomic, read;  ///< of two invocations, where there are two that are in no order
  bool by_several = false;             ///< wrote the same value
};

struct Memory {
  std::string name;
  std::vector<Word> words;
  std::vector<Marks> marks;  ///< none: nobody ever writes here
  bool is_shared = false;    ///< of a group
  bool coherent = true;      ///< as the pass under way declares it

  void watch() { marks.resize(words.size()); }
};

/// What is wrong, once for each two places in the text.
struct Finding {
  std::string kind, memory;
  Word first = 0, second = 0;  ///< lines
  bool operator<(const Finding& other) const {
    return std::tie(kind, memory, first, second) < std::tie(other.kind, other.memory, other.first, other.second);
  }
};

/// Up to where the work of groups is visible to who takes a lock.
struct Release {
  Word epoch = 0;
  std::vector<Word> seen;  ///< fences of the group's invocations
};
using Releases = std::map<Word, Release>;  ///< by group

class Referee {
 public:
  void begin_dispatch() { ++dispatch_, crossed_ = arguments_crossed_, arguments_crossed_ = false; }
  // Of the host, behind the dispatches so far: for the memory of later ones, and for their numbers of groups.
  void host_barrier() { open_ = dispatch_ + 1; }
  void argument_barrier() { arguments_open_ = dispatch_ + 1; }
  void begin_group(Word group, Word size);
  /// All invocations of the group have come to it.
  void barrier();
  void fence(Word lane);

  // By an invocation of the group under way.
  Word read(Memory& memory, Word at, Word lane, Word line);
  void write(Memory& memory, Word at, Word value, Word lane, Word line);
  /// Before an atomic operation; returns the word for it.
  Word& atomic(Memory& memory, Word at, Word lane, Word line);
  /// The next dispatch takes its number of groups from here.
  void read_arguments(const Memory& memory, Word at);

  void report(const std::string& kind, const std::string& memory, Word first, Word second) {
    findings_.insert({kind, memory, first, second});
  }
  const std::set<Finding>& findings() const { return findings_; }
  void forget_findings() { findings_.clear(); }
  /// Whether the dispatch under way needs the barrier between it and the one before.
  bool needs_barrier() const { return crossed_; }

 private:
  Word stamp(const Memory& memory) const { return memory.is_shared ? group_serial_ : dispatch_; }
  Word who(Word lane) const { return group_ * size_ + lane; }
  bool is_released(const Access& before, const Releases& releases, bool must_see) const;
  bool in_order(const Access& before, const Memory& memory, Word lane, bool must_see);
  void note(std::array<Access, 2>& accesses, const Memory& memory, Word lane, Word line);
  void set(Access& access, const Memory& memory, Word lane, Word line);
  void exchange_locks(const Memory& memory, Word at, Word lane);
  bool is_outside(const Memory& memory, Word at, Word line);

  Word dispatch_ = 0, open_ = 1, arguments_open_ = 1, group_ = 0, size_ = 1, epoch_ = 1, group_serial_ = 0;
  bool crossed_ = false, arguments_crossed_ = false;
  std::vector<Word> fences_, seen_;  ///< by invocation of the group; seen: at the last barrier
  /// What invocations found at locks, what they may rely on since a fence, and the whole group since a barrier.
  std::vector<Releases> found_, own_;
  Releases taken_over_;
  std::map<std::pair<const Memory*, Word>, Releases> locks_;
  std::set<Finding> findings_;
  Word nowhere_ = 0;
};

}  // namespace bin_scenes::races
