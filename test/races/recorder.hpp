/// What is dispatched runs in the interpreter first, on copies of the buffers, and then on the device, which must make
/// the same of them.
#pragma once

#include "races/gl_listener.hpp"
#include "races/referee.hpp"
#include "races/run.hpp"

#include <map>
#include <string>
#include <vector>

namespace bin_scenes::races {

/// A dispatch that can be repeated.
struct Record {
  Pass pass;
  Dispatch dispatch;
  std::vector<Memory> buffers;  ///< as they were before it
  std::uint64_t steps = 0;      ///< instructions that it took

  /// Runs it on copies, which it returns. `referee` is one that saw nothing before.
  std::vector<Memory> repeat(Referee& referee, const Choices& choices, Outcome* outcome = nullptr) const;
};

struct Count {
  unsigned dispatches = 0;       ///< with at least one group
  unsigned needed_barriers = 0;  ///< of these, how many touch what the dispatch before them touched
};

struct Observations {
  std::vector<std::string> findings;
  std::vector<Record> records;          ///< some of each pass with barriers
  std::map<std::string, Count> counts;  ///< by pass
  std::uint64_t steps = 0;              ///< instructions
};

class Recorder final : public GlListener {
 public:
  Recorder() : GlListener(Optimise::no) {}

  /// Dispatches are checked from now on; the first is in order with all before it. Where room runs out, who comes first
  /// has it, and results are not those of the device.
  void begin(bool compares = true);
  void end() { watch(false); }
  const Observations& seen() const { return seen_; }

  void take_barrier(unsigned bits) override;
  void take_arguments(unsigned buffer, std::size_t offset) override;
  void take_dispatch(const Groups& groups, const std::function<void()>& issue) override;

 private:
  Dispatch prepare(const Pass& pass, const Groups& groups);
  Memory& download(unsigned buffer, const std::string& name);
  void compare(const Record& record, const std::vector<Memory>& first, const std::vector<Memory>& second,
               const std::vector<Memory>& device);
  void add(const std::string& finding);
  void take_findings(const Pass& pass, Referee& referee);
  void keep(const Record& record);

  bool compares_ = true;
  std::map<unsigned, Memory> memories_;  ///< by name of the buffer
  std::vector<unsigned> bound_;          ///< of the dispatch under way
  Referee referee_;
  Observations seen_;
  std::map<std::string, unsigned> kept_;
};

}  // namespace bin_scenes::races
