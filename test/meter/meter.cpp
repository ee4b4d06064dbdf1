#include "meter/meter.hpp"

#include "meter/warp.hpp"

#include <algorithm>

namespace bin_scenes::meter {

namespace {

void add(Sectors& to, const Sectors& more) {
  to.loaded += more.loaded;
  to.stored += more.stored;
}

void add_places(const Program& program, Counts& counts) {
  for (std::size_t at = 0; at < program.spent.size(); ++at) {
    const LineCost& spent = program.spent[at];
    if (spent.slots == 0) continue;
    counts.slots += spent.slots;
    counts.lane_slots += spent.lane_slots;
    LineCost& line = counts.lines[program.module.place_of(program.module.code[at].line)];
    line.slots += spent.slots;
    line.lane_slots += spent.lane_slots;
  }
  for (std::size_t k = 0; k < program.of_buffers.size(); ++k) {
    add(counts.sectors, program.of_buffers[k]);
    add(counts.buffers[program.module.buffers[k].name], program.of_buffers[k]);
  }
}

void add_counts(const Counts& more, Counts& to) {
  to.groups += more.groups;
  to.warps += more.warps;
  to.loads += more.loads;
  to.stores += more.stores;
  to.l1_hits += more.l1_hits;
  to.shared_loads += more.shared_loads;
  to.shared_stores += more.shared_stores;
  to.atomics += more.atomics;
  to.barriers += more.barriers;
  to.branches += more.branches;
  to.divergent += more.divergent;
}

}  // namespace

void measure(const races::Dispatch& dispatch, const Card& card, Counts& counts) {
  Program program(dispatch, card);
  Group group(program);
  double longest = 0, sum = 0;
  const Word groups = dispatch.groups[0] * dispatch.groups[1] * dispatch.groups[2];
  for (Word number = 0; number < groups; ++number) {
    const double cycles = group.run(number);
    longest = std::max(longest, cycles);
    sum += cycles;
  }
  const double before = counts.slots;
  add_places(program, counts);
  add_counts(program.counts, counts);
  ++counts.dispatches;
  counts.latency += sum;
  counts.longest = std::max(counts.longest, longest);
  counts.shared_words = program.module.shared_words;
  counts.code_bytes = card.bytes_of_code * program.module.instructions;
  counts.dispatch_us +=
      card.launch_us + std::max(longest / card.clock_mhz, full_issue_us(counts.slots - before, 1, card));
}

double full_issue_us(double slots, double worlds, const Card& card) {
  return slots * worlds / (card.multiprocessors * card.schedulers * card.clock_mhz);
}

}  // namespace bin_scenes::meter
