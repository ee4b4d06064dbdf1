/// What each instruction does to the lanes of a warp, and when its result is there.
#include "meter/warp.hpp"

#include "races/arithmetic.hpp"

#include <spirv/unified1/spirv.hpp11>

#include <algorithm>
#include <stdexcept>

namespace bin_scenes::meter {

using namespace races;
using spv::Op;

namespace {

constexpr Word words_per_sector = 8;

/// What an atomic operation leaves in the place of `word`.
Word changed(const Instruction& i, const Word* r, Word word) {
  const Word value = r[i.b];
  switch (static_cast<Op>(i.code)) {
    case Op::OpAtomicIAdd:
      return word + value;
    case Op::OpAtomicUMin:
      return std::min(word, value);
    case Op::OpAtomicUMax:
      return std::max(word, value);
    case Op::OpAtomicOr:
      return word | value;
    case Op::OpAtomicAnd:
      return word & value;
    case Op::OpAtomicXor:
      return word ^ value;
    case Op::OpAtomicExchange:
      return value;
    case Op::OpAtomicCompareExchange:
      return word == r[i.c] ? value : word;
    default:  // OpAtomicLoad
      return word;
  }
}

}  // namespace

bool Group::execute(Warp& warp, const Instruction& i, Word& at) {
  const Flow& flow = program_.flows[at - 1];
  double from = warp.issued();
  for (const Word word : flow.reads) from = std::max<double>(from, warp.ready[word]);
  switch (i.code) {
    case copy:
    case copy_list:
      move(warp, i);
      return true;
    case load_registers:
    case store_registers:
      access_local(warp, i);
      break;
    case load_buffer:
    case store_buffer:
      access_buffer(warp, i, from);
      return true;
    case load_shared:
    case store_shared:
      access_shared(warp, i, from);
      return true;
    case static_cast<Word>(Op::OpAccessChain):
      chain(warp, i);
      break;
    case static_cast<Word>(Op::OpLabel):
      enter(warp, i, at);
      return true;
    case static_cast<Word>(Op::OpMemoryBarrier):
      return true;
    case static_cast<Word>(Op::OpBranch):
    case static_cast<Word>(Op::OpBranchConditional):
    case static_cast<Word>(Op::OpSwitch):
      branch(warp, i, from);
      return false;
    case static_cast<Word>(Op::OpReturn):
    case static_cast<Word>(Op::OpUnreachable):
      for (Word k = 0; k < warp.active; ++k) lanes_[warp.lanes[k]].ended = true;
      return false;
    case static_cast<Word>(Op::OpControlBarrier):
      for (Word k = 0; k < warp.active; ++k) lanes_[warp.lanes[k]].waits = true, lanes_[warp.lanes[k]].at = at;
      return false;
    default:
      if (is_atomic(i.code))
        exchange(warp, i);
      else
        compute(warp, i);
  }
  write_at(warp, flow, from + program_.costs[at - 1].latency);
  return true;
}

void Group::write_at(Warp& warp, const Flow& flow, double cycle) {
  for (const Word word : flow.writes) warp.ready[word] = static_cast<float>(cycle);
}

void Group::move(Warp& warp, const Instruction& i) {
  const auto source = [&](Word k) { return i.code == copy ? i.a + k : module_.lists[i.c + k]; };
  for (Word k = 0; k < i.n; ++k) warp.ready[i.to + k] = warp.ready[source(k)];
  for (Word lane = 0; lane < warp.active; ++lane) {
    Word* const r = registers_of(warp, lane);
    for (Word k = 0; k < i.n; ++k) r[i.to + k] = r[source(k)];
  }
}

void Group::access_local(Warp& warp, const Instruction& i) {
  for (Word lane = 0; lane < warp.active; ++lane) {
    Word* const r = registers_of(warp, lane);
    if (i.code == load_registers)
      std::copy_n(r + r[i.a + 1], i.n, r + i.to);
    else
      std::copy_n(r + i.a, i.n, r + r[i.to + 1]);
  }
}

void Group::access_buffer(Warp& warp, const Instruction& i, double from) {
  const bool load = i.code == load_buffer;
  const Word pointer = load ? i.a : i.to;
  const Word variable = registers_of(warp, 0)[pointer], memory_id = program_.same_memory[variable];
  Memory& memory = *program_.dispatch.buffers[variable];
  sectors_.clear();
  for (Word lane = 0; lane < warp.active; ++lane) {
    Word* const r = registers_of(warp, lane);
    for (Word k = 0; k < i.n; ++k) {
      const Word value = module_.lists[i.c + 2 * k];
      const std::size_t at = std::size_t{r[pointer + 1]} + module_.lists[i.c + 2 * k + 1];
      const bool inside = at < memory.words.size();  // what lies outside reads as zero, as drivers do it
      if (load)
        r[i.to + value] = inside ? memory.words[at] : 0;
      else if (inside)
        memory.words[at] = r[i.a + value];
      const std::uint64_t sector = std::uint64_t{memory_id} << 40 | at / words_per_sector;
      if (inside && (sectors_.empty() || sectors_.back() != sector)) sectors_.push_back(sector);
    }
  }
  std::sort(sectors_.begin(), sectors_.end());
  sectors_.erase(std::unique(sectors_.begin(), sectors_.end()), sectors_.end());
  if (!load) {
    ++program_.counts.stores;
    program_.of_buffers[variable].stored += sectors_.size();
    warp.stored[memory_id] = std::max(warp.stored[memory_id], from);
    warp.settled = std::max(warp.settled, from);
    return;
  }
  ++program_.counts.loads;
  program_.of_buffers[variable].loaded += sectors_.size();
  from = std::max(from, warp.stored[memory_id]);  // a store before it may have gone to the same place
  const double latency = latency_of(sectors_, module_.buffers[variable].coherent, (i.n + 3) / 4);
  for (Word k = 0; k < i.n; ++k) warp.ready[i.to + module_.lists[i.c + 2 * k]] = static_cast<float>(from + latency);
}

/// That of the slowest sector, and two cycles for each four sectors beyond the 128 bytes that an instruction of one
/// piece moves at once.
double Group::latency_of(const std::vector<std::uint64_t>& sectors, bool coherent, Word pieces) {
  double latency = sectors.empty() ? program_.card.l1 : 0;
  for (const std::uint64_t sector : sectors) {
    const bool hit = !coherent && program_.l1.touch(sector);
    program_.counts.l1_hits += hit;
    latency = std::max(latency, hit ? program_.card.l1 : program_.card.l2);
  }
  return latency + 2.0 * std::max(0.0, static_cast<double>(sectors.size()) / 4 - pieces);
}

void Group::access_shared(Warp& warp, const Instruction& i, double from) {
  const bool load = i.code == load_shared;
  const Word pointer = load ? i.a : i.to;
  for (Word lane = 0; lane < warp.active; ++lane) {
    Word* const r = registers_of(warp, lane);
    for (Word k = 0; k < i.n; ++k) {
      const Word value = module_.lists[i.c + 2 * k], at = r[pointer + 1] + module_.lists[i.c + 2 * k + 1];
      if (load)
        r[i.to + value] = shared_.at(at);
      else
        shared_.at(at) = r[i.a + value];
    }
  }
  double& stored = warp.stored.back();
  if (load) {
    ++program_.counts.shared_loads;
    from = std::max(from, stored);
    for (Word k = 0; k < i.n; ++k)
      warp.ready[i.to + module_.lists[i.c + 2 * k]] = static_cast<float>(from + program_.card.shared);
  } else {
    ++program_.counts.shared_stores;
    stored = std::max(stored, from);
    warp.settled = std::max(warp.settled, from);
  }
}

/// Lanes one after the other, as a device does it in some order.
void Group::exchange(Warp& warp, const Instruction& i) {
  ++program_.counts.atomics;
  for (Word lane = 0; lane < warp.active; ++lane) {
    Word* const r = registers_of(warp, lane);
    const Word at = r[i.a + 1];
    std::vector<Word>& words = i.n ? program_.dispatch.buffers[r[i.a]]->words : shared_;
    const Word before = at < words.size() ? words[at] : 0;
    if (at < words.size()) words[at] = changed(i, r, before);
    r[i.to] = before;
  }
}

void Group::chain(Warp& warp, const Instruction& i) {
  for (Word lane = 0; lane < warp.active; ++lane) {
    Word* const r = registers_of(warp, lane);
    Word offset = r[i.a + 1] + i.b;
    for (Word k = 0; k < i.n; ++k) offset += r[module_.lists[i.c + 3 * k]] * module_.lists[i.c + 3 * k + 1];
    const Word block = r[i.a];
    r[i.to] = block;
    r[i.to + 1] = offset;
  }
}

/// At a label: the values that depend on where a lane comes from are all chosen before any is assigned.
void Group::enter(Warp& warp, const Instruction& label, Word& at) {
  for (Word lane = 0; lane < warp.active; ++lane) {
    Lane& l = lanes_[warp.lanes[lane]];
    l.previous = l.block;
    l.block = label.a;
  }
  Word end = at;
  while (module_.code[end].code == static_cast<Word>(Op::OpPhi)) ++end;
  if (end > at) assign_phis(warp, at, end);
  at = end;
}

void Group::assign_phis(Warp& warp, Word at, Word end) {
  const auto source = [&](const Instruction& phi, Word previous) {
    for (Word k = 0; k < phi.a; ++k)
      if (module_.lists[phi.c + 2 * k] == previous) return module_.lists[phi.c + 2 * k + 1];
    throw std::runtime_error("a block that is entered from nowhere, at " + module_.place_of(phi.line));
  };
  for (Word lane = 0; lane < warp.active; ++lane) {
    Lane& l = lanes_[warp.lanes[lane]];
    phi_values_.clear();
    for (Word x = at; x < end; ++x) {
      const Instruction& phi = module_.code[x];
      const Word from = source(phi, l.previous);
      for (Word k = 0; k < phi.n; ++k) phi_values_.push_back({phi.to + k, l.registers[from + k]});
    }
    for (const auto& [to, value] : phi_values_) l.registers[to] = value;
  }
  std::vector<float> ready;  // by the first lane, which stands for all
  for (Word x = at; x < end; ++x) {
    const Instruction& phi = module_.code[x];
    spend(warp, x, program_.costs[x].slots);
    const Word from = source(phi, lanes_[warp.lanes[0]].previous);
    for (Word k = 0; k < phi.n; ++k) ready.push_back(warp.ready[from + k]);
  }
  auto next = ready.begin();
  for (Word x = at; x < end; ++x)
    for (Word k = 0; k < module_.code[x].n; ++k) warp.ready[module_.code[x].to + k] = *next++;
}

void Group::branch(Warp& warp, const Instruction& i, double decided) {
  if (static_cast<Op>(i.code) == Op::OpBranch) {
    for (Word lane = 0; lane < warp.active; ++lane) lanes_[warp.lanes[lane]].at = i.b;
    return;
  }
  Word first = none;
  bool diverges = false;
  for (Word lane = 0; lane < warp.active; ++lane) {
    Lane& l = lanes_[warp.lanes[lane]];
    const Word value = l.registers[i.a];
    l.at = i.b;
    if (static_cast<Op>(i.code) == Op::OpBranchConditional) l.at = value ? i.b : i.c;
    for (Word k = 0; static_cast<Op>(i.code) == Op::OpSwitch && k < i.n; ++k)
      if (value == module_.lists[i.c + 2 * k]) l.at = module_.lists[i.c + 2 * k + 1];
    diverges |= first != none && l.at != first;
    first = l.at;
  }
  ++program_.counts.branches;
  program_.counts.divergent += diverges;
  warp.settled = std::max(warp.settled, decided) + program_.card.branch;
}

void Group::compute(Warp& warp, const Instruction& i) {
  if (i.code >= extended) {
    for (Word lane = 0; lane < warp.active; ++lane) compute_extended(i, registers_of(warp, lane));
    return;
  }
  const bool extracts = static_cast<Op>(i.code) == Op::OpVectorExtractDynamic;
  for (Word lane = 0; lane < warp.active; ++lane) {
    Word* const r = registers_of(warp, lane);
    if (extracts)
      std::copy_n(r + i.a + r[i.b] % i.c * i.n, i.n, r + i.to);
    else if (!races::compute(i, r))
      throw std::runtime_error("SPIR-V instruction " + std::to_string(i.code) + " at " + module_.place_of(i.line));
  }
}

}  // namespace bin_scenes::meter
