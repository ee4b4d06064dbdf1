/// A work group in lockstep: 32 lanes execute one instruction at a time, those that are at the same place in the code.
/// Where lanes took different branches, the ones that are furthest behind go first, so that they meet again.
///
/// Time is that of a dataflow machine: an instruction begins when the warp has issued all before it and its operands
/// are there; a block ends when its branch is decided. A warp has the schedulers for itself: how warps delay each other
/// is left to what bounds a dispatch as a whole (meter.cpp).
#pragma once

#include "meter/cache.hpp"
#include "meter/costs.hpp"
#include "meter/counts.hpp"
#include "meter/flow.hpp"
#include "races/run.hpp"

#include <array>
#include <vector>

namespace bin_scenes::meter {

using races::Dispatch;
using races::Memory;

/// What all groups of a dispatch share.
struct Program {
  Program(const Dispatch& dispatch, const Card& card);

  const Dispatch& dispatch;
  const races::Module& module;
  const Card& card;
  std::vector<Cost> costs;          ///< by place in the code
  std::vector<Flow> flows;          ///< the same
  std::vector<Word> start;          ///< registers as an invocation begins
  std::vector<Word> same_memory;    ///< by buffer variable: the first one that is bound to the same buffer
  std::vector<LineCost> spent;      ///< by place in the code
  std::vector<Sectors> of_buffers;  ///< by buffer variable
  Cache l1;
  Counts counts;
};

class Group {
 public:
  explicit Group(Program& program);

  /// Returns the cycles until its last warp has ended.
  double run(Word number);

 private:
  struct Lane {
    std::vector<Word> registers;
    Word at = 0, block = 0, previous = 0;  ///< place in the code; labels
    bool waits = false, ended = false;
  };
  struct Warp {
    std::vector<float> ready;    ///< cycle from which a register can be read
    std::vector<double> stored;  ///< by memory: when the last store went out; the group's memory is behind the buffers
    double begin = 0;            ///< cycle of the block under way
    double slots = 0;            ///< issued in it
    double settled = 0;          ///< cycle before which it cannot end
    std::array<Word, 32> lanes{};
    Word active = 0;  ///< of `lanes`: those that take part

    double issued() const { return begin + slots; }
  };

  void begin(Word number);
  void set_inputs(Lane& lane, Word index, const std::array<Word, 3>& place) const;
  void advance(Warp& warp, Word first);
  bool choose_lanes(Warp& warp, Word first) const;
  /// Executes up to the end of the block.
  void run_block(Warp& warp);
  /// False at an instruction that ends a block.
  bool execute(Warp& warp, const Instruction& i, Word& at);
  void spend(Warp& warp, Word at, double slots);

  // Instructions; `from` is the cycle at which operands are there.
  void move(Warp& warp, const Instruction& i);
  void access_local(Warp& warp, const Instruction& i);
  void access_buffer(Warp& warp, const Instruction& i, double from);
  void access_shared(Warp& warp, const Instruction& i, double from);
  double latency_of(const std::vector<std::uint64_t>& sectors, bool coherent, Word pieces);
  void exchange(Warp& warp, const Instruction& i);
  void chain(Warp& warp, const Instruction& i);
  void enter(Warp& warp, const Instruction& label, Word& at);
  void assign_phis(Warp& warp, Word at, Word end);
  void branch(Warp& warp, const Instruction& i, double decided);
  void compute(Warp& warp, const Instruction& i);
  Word* registers_of(const Warp& warp, Word k) { return lanes_[warp.lanes[k]].registers.data(); }
  void write_at(Warp& warp, const Flow& flow, double cycle);

  Program& program_;
  const races::Module& module_;
  std::vector<Lane> lanes_;
  std::vector<Warp> warps_;
  std::vector<Word> shared_;
  std::vector<std::uint64_t> sectors_;             ///< of the access under way
  std::vector<std::pair<Word, Word>> phi_values_;  ///< register, value
};

}  // namespace bin_scenes::meter
