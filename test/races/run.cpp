#include "races/run.hpp"

#include "races/arithmetic.hpp"

#include <spirv/unified1/spirv.hpp11>

#include <algorithm>
#include <numeric>
#include <random>
#include <stdexcept>

namespace bin_scenes::races {

namespace {

using spv::Op;

struct Frame {
  Word back = 0, to = 0, block = 0;
};

struct Invocation {
  std::vector<Word> registers;
  std::vector<Frame> frames;
  Word at = 0;                   ///< in the code
  Word block = 0, previous = 0;  ///< labels
  bool waits = false, ended = false;
};

struct TooLong {};

bool changed(const Instruction& i, const Word* r, Word before, Word& after);

class Group {
 public:
  Group(const Dispatch& dispatch, Referee& referee, const Choices& choices, Outcome& outcome)
      : dispatch_(dispatch),
        module_(*dispatch.module),
        referee_(referee),
        choices_(choices),
        outcome_(outcome),
        random_(choices.seed),
        left_out_(choices.without == none ? none : module_.barriers.at(choices.without)),
        start_(module_.registers),
        invocations_(module_.group_size),
        shared_(module_.shared.size()) {
    for (const Variable& uniform : module_.uniforms) {
      const auto value = dispatch.uniforms.find(uniform.name);
      if (value != dispatch.uniforms.end()) start_[uniform.place] = value->second;
    }
    for (std::size_t k = 0; k < shared_.size(); ++k) {
      shared_[k].name = module_.shared[k].name;
      shared_[k].is_shared = true;
      shared_[k].words.resize(module_.shared[k].words);
      shared_[k].watch();
    }
    owner_.resize(module_.shared_words);
    for (Word k = 0; k < module_.shared.size(); ++k)
      std::fill_n(owner_.begin() + module_.shared[k].place, module_.shared[k].words, k);
  }

  void run(Word number) {
    begin(number);
    std::vector<Word> order(module_.group_size);
    std::iota(order.begin(), order.end(), 0u);
    for (bool goes_on = true; goes_on;) {
      std::shuffle(order.begin(), order.end(), random_);
      for (const Word lane : order) {
        if (choices_.stop_at_first && !referee_.findings().empty()) return;
        advance(lane);
      }
      goes_on = meet();
    }
  }

 private:
  void begin(Word number) {
    const auto& groups = dispatch_.groups;
    const std::array<Word, 3> place{number % groups[0], number / groups[0] % groups[1], number / groups[0] / groups[1]};
    for (Memory& memory : shared_)  // nobody promises zeros
      for (Word& word : memory.words) word = static_cast<Word>(random_());
    for (Word lane = 0; lane < module_.group_size; ++lane) {
      Invocation& invocation = invocations_[lane];
      invocation.registers = start_;
      invocation.frames.clear();
      invocation.at = module_.entry;
      invocation.waits = invocation.ended = false;
      const auto set = [&](spv::BuiltIn built_in, const std::array<Word, 3>& value) {
        const auto input = module_.inputs.find(static_cast<Word>(built_in));
        if (input != module_.inputs.end())
          std::copy_n(value.begin(), input->second.words, invocation.registers.begin() + input->second.place);
      };
      set(spv::BuiltIn::LocalInvocationIndex, {lane, 0, 0});
      set(spv::BuiltIn::LocalInvocationId, {lane, 0, 0});
      set(spv::BuiltIn::WorkgroupId, place);
      set(spv::BuiltIn::NumWorkgroups, groups);
      set(spv::BuiltIn::GlobalInvocationId, {place[0] * module_.group_size + lane, place[1], place[2]});
    }
    referee_.begin_group(number, module_.group_size);
  }

  /// All have come to a barrier or to their end; false if that is the end of the group.
  bool meet() {
    const auto waiting = [](const Invocation& i) { return i.waits; };
    const auto first = std::find_if(invocations_.begin(), invocations_.end(), waiting);
    if (first == invocations_.end()) return false;
    for (const Invocation& i : invocations_)
      if (!i.waits || i.at != first->at) {
        referee_.report("barrier that not all come to", "", module_.code[first->at - 1].line, 0);
        return false;
      }
    for (Invocation& i : invocations_) i.waits = false;
    referee_.barrier();
    return true;
  }

  Memory& buffer(Word number) {
    Memory& memory = *dispatch_.buffers[number];
    memory.coherent = module_.buffers[number].coherent;
    return memory;
  }
  Memory& shared(Word at, Word& inside) {
    const Word k = at < owner_.size() ? owner_[at] : 0;
    inside = at - module_.shared[k].place;
    return shared_[k];
  }

  void advance(Word lane);
  bool change(const Instruction& i, Word* r, Word lane);

  const Dispatch& dispatch_;
  const Module& module_;
  Referee& referee_;
  const Choices& choices_;
  Outcome& outcome_;
  std::mt19937_64 random_;
  Word left_out_;
  std::vector<Word> start_;
  std::vector<Invocation> invocations_;
  std::vector<Memory> shared_;
  std::vector<Word> owner_;  ///< variable of each word of the group's memory
};

/// Until a barrier or the end.
void Group::advance(Word lane) {
  Invocation& invocation = invocations_[lane];
  Word* const r = invocation.registers.data();
  const Word* const lists = module_.lists.data();
  while (!invocation.ended) {
    const Instruction& i = module_.code[invocation.at];
    ++invocation.at;
    if (++outcome_.steps > choices_.most_steps) throw TooLong();
    switch (i.code) {
      case copy:
        std::copy_n(r + i.a, i.n, r + i.to);
        break;
      case copy_list:
        for (Word k = 0; k < i.n; ++k) r[i.to + k] = r[lists[i.c + k]];
        break;
      case load_registers:
        std::copy_n(r + r[i.a + 1], i.n, r + i.to);
        break;
      case store_registers:
        std::copy_n(r + i.a, i.n, r + r[i.to + 1]);
        break;
      case load_buffer: {
        Memory& memory = buffer(r[i.a]);
        for (const Word* part = lists + i.c; part < lists + i.c + 2 * i.n; part += 2)
          r[i.to + part[0]] = referee_.read(memory, r[i.a + 1] + part[1], lane, i.line);
        break;
      }
      case store_buffer: {
        Memory& memory = buffer(r[i.to]);
        for (const Word* part = lists + i.c; part < lists + i.c + 2 * i.n; part += 2)
          referee_.write(memory, r[i.to + 1] + part[1], r[i.a + part[0]], lane, i.line);
        break;
      }
      case load_shared: {
        Word at = 0;
        Memory& memory = shared(r[i.a + 1], at);
        for (const Word* part = lists + i.c; part < lists + i.c + 2 * i.n; part += 2)
          r[i.to + part[0]] = referee_.read(memory, at + part[1], lane, i.line);
        break;
      }
      case store_shared: {
        Word at = 0;
        Memory& memory = shared(r[i.to + 1], at);
        for (const Word* part = lists + i.c; part < lists + i.c + 2 * i.n; part += 2)
          referee_.write(memory, at + part[1], r[i.a + part[0]], lane, i.line);
        break;
      }
      case static_cast<Word>(Op::OpAccessChain): {
        Word offset = r[i.a + 1] + i.b;
        for (const Word* step = lists + i.c; step < lists + i.c + 3 * i.n; step += 3) {
          const bool beyond = step[2] != 0 && r[step[0]] >= step[2];
          if (beyond) referee_.report("index beyond an array", "", i.line, i.line);
          offset += beyond ? 0 : r[step[0]] * step[1];
        }
        r[i.to] = r[i.a];
        r[i.to + 1] = offset;
        break;
      }
      case static_cast<Word>(Op::OpLabel):
        invocation.previous = invocation.block;
        invocation.block = i.a;
        break;
      case static_cast<Word>(Op::OpPhi):
        for (Word k = 0; k < i.a; ++k)
          if (lists[i.c + 2 * k] == invocation.previous) std::copy_n(r + lists[i.c + 2 * k + 1], i.n, r + i.to);
        break;
      case static_cast<Word>(Op::OpBranch):
        invocation.at = i.b;
        break;
      case static_cast<Word>(Op::OpBranchConditional):
        invocation.at = r[i.a] ? i.b : i.c;
        break;
      case static_cast<Word>(Op::OpSwitch): {
        invocation.at = i.b;
        for (Word k = 0; k < i.n; ++k)
          if (r[i.a] == lists[i.c + 2 * k]) invocation.at = lists[i.c + 2 * k + 1];
        break;
      }
      case static_cast<Word>(Op::OpVectorExtractDynamic):
        std::copy_n(r + i.a + r[i.b] % i.c * i.n, i.n, r + i.to);
        break;
      case static_cast<Word>(Op::OpFunctionCall):
        for (Word k = 0; k < i.n; ++k) r[lists[i.c + 2 * k]] = r[lists[i.c + 2 * k + 1]];
        invocation.frames.push_back({invocation.at, i.to, invocation.block});
        invocation.at = i.a;
        break;
      case static_cast<Word>(Op::OpReturnValue):
        std::copy_n(r + i.a, i.n, r + invocation.frames.back().to);
        [[fallthrough]];
      case static_cast<Word>(Op::OpReturn):
        if (invocation.frames.empty()) {
          invocation.ended = true;
          break;
        }
        invocation.at = invocation.frames.back().back;
        invocation.block = invocation.frames.back().block;
        invocation.frames.pop_back();
        break;
      case static_cast<Word>(Op::OpControlBarrier):
        if (invocation.at - 1 == left_out_) {
          outcome_.left_out = true;
          break;
        }
        invocation.waits = true;
        return;
      case static_cast<Word>(Op::OpMemoryBarrier):
        if (invocation.at - 1 == left_out_)
          outcome_.left_out = true;
        else
          referee_.fence(lane);
        break;
      default:
        if (i.code >= extended)
          compute_extended(i, r);
        else if (!compute(i, r) && !change(i, r, lane))
          throw std::runtime_error("SPIR-V instruction " + std::to_string(i.code) + " at " + module_.place_of(i.line));
    }
  }
}

/// What an atomic operation leaves in the place of `before`; false if it is none that is known here.
bool changed(const Instruction& i, const Word* r, Word before, Word& after) {
  const Word value = r[i.b];
  switch (static_cast<Op>(i.code)) {
    case Op::OpAtomicLoad:
      after = before;
      return true;
    case Op::OpAtomicIAdd:
      after = before + value;
      return true;
    case Op::OpAtomicUMin:
      after = std::min(before, value);
      return true;
    case Op::OpAtomicUMax:
      after = std::max(before, value);
      return true;
    case Op::OpAtomicOr:
      after = before | value;
      return true;
    case Op::OpAtomicAnd:
      after = before & value;
      return true;
    case Op::OpAtomicXor:
      after = before ^ value;
      return true;
    case Op::OpAtomicExchange:
      after = value;
      return true;
    case Op::OpAtomicCompareExchange:
      after = before == r[i.c] ? value : before;
      return true;
    default:
      return false;
  }
}

bool Group::change(const Instruction& i, Word* r, Word lane) {
  Word after = 0;
  if (!changed(i, r, 0, after)) return false;
  Word at = r[i.a + 1];
  Memory& memory = i.n ? buffer(r[i.a]) : shared(at, at);
  Word& word = referee_.atomic(memory, at, lane, i.line);
  const Word before = word;
  changed(i, r, before, word);
  r[i.to] = before;
  return true;
}

}  // namespace

Outcome run(const Dispatch& dispatch, Referee& referee, const Choices& choices) {
  Outcome outcome;
  std::vector<Word> order(dispatch.groups[0] * dispatch.groups[1] * dispatch.groups[2]);
  std::iota(order.begin(), order.end(), 0u);
  std::mt19937_64 random(choices.seed);
  std::shuffle(order.begin(), order.end(), random);
  referee.begin_dispatch();
  try {
    Group group(dispatch, referee, choices, outcome);
    for (const Word number : order) {
      if (choices.stop_at_first && !referee.findings().empty()) break;
      group.run(number);
    }
  } catch (const TooLong&) {
    referee.report("endless", "", 0, 0);
  }
  return outcome;
}

}  // namespace bin_scenes::races
