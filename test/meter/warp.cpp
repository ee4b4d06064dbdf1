/// The order in which lanes and blocks of a group are executed; instructions themselves: execute.cpp.
#include "meter/warp.hpp"

#include <spirv/unified1/spirv.hpp11>

#include <algorithm>

namespace bin_scenes::meter {

using namespace races;
using spv::Op;

namespace {

constexpr Word lanes_per_warp = 32;

}  // namespace

Program::Program(const Dispatch& of, const Card& on)
    : dispatch(of),
      module(*of.module),
      card(on),
      start(module.registers),
      spent(module.code.size()),
      of_buffers(of.buffers.size()),
      l1(on.l1_bytes) {
  for (const Variable& uniform : module.uniforms) {
    const auto value = dispatch.uniforms.find(uniform.name);
    if (value != dispatch.uniforms.end()) start[uniform.place] = value->second;
  }
  for (const Instruction& i : module.code) {
    costs.push_back(cost_of(i, card));
    const bool moves = i.code == copy || i.code == copy_list || i.code == static_cast<Word>(Op::OpPhi);
    flows.push_back(moves ? Flow{} : flow_of(i, module));
  }
  for (const Memory* memory : dispatch.buffers)
    same_memory.push_back(static_cast<Word>(std::find(dispatch.buffers.begin(), dispatch.buffers.end(), memory) -
                                            dispatch.buffers.begin()));
}

Group::Group(Program& program)
    : program_(program),
      module_(program.module),
      lanes_(module_.group_size),
      warps_((module_.group_size + lanes_per_warp - 1) / lanes_per_warp),
      shared_(module_.shared_words) {}

double Group::run(Word number) {
  begin(number);
  for (;;) {
    double latest = 0;
    for (std::size_t w = 0; w < warps_.size(); ++w) {
      advance(warps_[w], static_cast<Word>(w) * lanes_per_warp);
      latest = std::max(latest, warps_[w].begin);
    }
    bool waiting = false;
    for (Lane& lane : lanes_) waiting |= lane.waits, lane.waits = false;
    if (!waiting) return latest;
    ++program_.counts.barriers;
    for (Warp& warp : warps_) warp.begin = latest + program_.card.barrier;
  }
}

void Group::begin(Word number) {
  const auto& groups = program_.dispatch.groups;
  const std::array<Word, 3> place{number % groups[0], number / groups[0] % groups[1], number / groups[0] / groups[1]};
  std::fill(shared_.begin(), shared_.end(), 0xcdcdcdcdu);  // nobody promises zeros
  for (Word index = 0; index < lanes_.size(); ++index) {
    Lane& lane = lanes_[index];
    lane.registers = program_.start;
    lane.at = module_.entry;
    lane.block = lane.previous = 0;
    lane.waits = lane.ended = false;
    set_inputs(lane, index, place);
  }
  for (Warp& warp : warps_) {
    warp.ready.assign(program_.start.size(), 0);
    warp.stored.assign(program_.dispatch.buffers.size() + 1, 0);
    warp.begin = 0;
  }
  ++program_.counts.groups;
  program_.counts.warps += warps_.size();
}

void Group::set_inputs(Lane& lane, Word index, const std::array<Word, 3>& place) const {
  const auto set = [&](spv::BuiltIn built_in, const std::array<Word, 3>& value) {
    const auto input = module_.inputs.find(static_cast<Word>(built_in));
    if (input != module_.inputs.end())
      std::copy_n(value.begin(), input->second.words, lane.registers.begin() + input->second.place);
  };
  set(spv::BuiltIn::LocalInvocationIndex, {index, 0, 0});
  set(spv::BuiltIn::LocalInvocationId, {index, 0, 0});
  set(spv::BuiltIn::WorkgroupId, place);
  set(spv::BuiltIn::NumWorkgroups, program_.dispatch.groups);
  set(spv::BuiltIn::GlobalInvocationId, {place[0] * module_.group_size + index, place[1], place[2]});
}

/// Until all its lanes have come to a barrier or to their end.
void Group::advance(Warp& warp, Word first) {
  while (choose_lanes(warp, first)) run_block(warp);
}

bool Group::choose_lanes(Warp& warp, Word first) const {
  const Word last = std::min<Word>(first + lanes_per_warp, static_cast<Word>(lanes_.size()));
  Word at = none;
  for (Word k = first; k < last; ++k)
    if (!lanes_[k].waits && !lanes_[k].ended) at = std::min(at, lanes_[k].at);
  warp.active = 0;
  for (Word k = first; k < last; ++k)
    if (!lanes_[k].waits && !lanes_[k].ended && lanes_[k].at == at) warp.lanes[warp.active++] = k;
  return warp.active > 0;
}

void Group::run_block(Warp& warp) {
  Word at = lanes_[warp.lanes[0]].at;
  warp.slots = 0;
  warp.settled = warp.begin;
  for (bool goes_on = true; goes_on;) {
    const Word here = at++;
    spend(warp, here, program_.costs[here].slots);
    goes_on = execute(warp, module_.code[here], at);
  }
  warp.begin = std::max(warp.issued(), warp.settled);
}

void Group::spend(Warp& warp, Word at, double slots) {
  warp.slots += slots;
  program_.spent[at].slots += slots;
  program_.spent[at].lane_slots += slots * warp.active;
}

}  // namespace bin_scenes::meter
