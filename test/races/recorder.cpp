#include "races/recorder.hpp"

#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace bin_scenes::races {

namespace {

float as_float(Word word) {
  float value;
  std::memcpy(&value, &word, sizeof value);
  return value;
}

/// Devices round divisions and roots in their own ways.
bool alike(Word a, Word b) {
  if (a == b) return true;
  const float x = as_float(a), y = as_float(b);
  return std::abs(x - y) <= 1e-2f * (std::abs(x) + std::abs(y)) + 2e-5f;
}

/// Words that may be other than on the device, of those that a pass changes: where two candidates are as good, rounding
/// chooses. In solve, rounding also decides whether a contact at the limit of friction slides, which changes the forces
/// (3 words) of all 8 contacts of its pair.
std::size_t most_ties(const std::string& pass, std::size_t changed) {
  return (pass == "solve" ? 24 : 8) + changed / 10;
}

/// Lists of what invocations came upon, in the order of arrival, and the chains that lie in the jobs; and of two edges
/// that cross, rounding says which one is the contact's.
bool is_compared(const std::string& pass, const std::string& buffer) {
  if (buffer == "Candidates" || buffer == "NearSamples" || buffer == "Touches") return false;
  return !(buffer == "Jobs" && (pass == "collect_samples" || pass == "test_samples" || pass == "offer_contacts"));
}

}  // namespace

std::vector<Memory> Record::repeat(Referee& referee, const Choices& choices, Outcome* outcome) const {
  std::vector<Memory> copies = buffers;
  Dispatch own = dispatch;
  for (std::size_t k = 0; k < copies.size(); ++k) {
    copies[k].watch();
    own.buffers[k] = &copies[k];
  }
  const Outcome made = run(own, referee, choices);
  if (outcome) *outcome = made;
  return copies;
}

void Recorder::begin(bool compares) {
  watch(true);
  compares_ = compares;
  memories_.clear();
  kept_.clear();
  referee_ = {};
}

void Recorder::take_barrier(unsigned bits) {
  if (bits & GL_SHADER_STORAGE_BARRIER_BIT) referee_.host_barrier();
  if (bits & GL_COMMAND_BARRIER_BIT) referee_.argument_barrier();
}

Memory& Recorder::download(unsigned buffer, const std::string& name) {
  Memory& memory = memories_[buffer];
  memory.name = name;
  memory.words = contents_of(buffer);
  return memory;
}

Dispatch Recorder::prepare(const Pass& pass, const Groups& groups) {
  Dispatch dispatch;
  dispatch.module = pass.module.get();
  dispatch.groups = groups;
  dispatch.uniforms = uniforms_of(pass);
  bound_.clear();
  for (const BufferVariable& variable : pass.module->buffers) {
    bound_.push_back(bound_to(pass, variable));
    Memory& memory = download(bound_.back(), variable.name);
    if (!variable.readonly) memory.watch();
    if (!memory.marks.empty()) memory.watch();
    dispatch.buffers.push_back(&memory);
  }
  return dispatch;
}

void Recorder::take_arguments(unsigned buffer, std::size_t offset) {
  const auto known = memories_.find(buffer);
  for (std::size_t k = 0; known != memories_.end() && k < Groups().size(); ++k)
    referee_.read_arguments(known->second, static_cast<Word>(offset / sizeof(Word) + k));
}

void Recorder::take_dispatch(const Groups& groups, const std::function<void()>& issue) {
  wait_for_device();
  const Pass pass = current_pass();
  Record record{pass, prepare(pass, groups), {}, 0};
  for (Memory* memory : record.dispatch.buffers) record.buffers.push_back({memory->name, memory->words, {}});

  const std::uint64_t steps = run(record.dispatch, referee_).steps;
  seen_.steps += steps;
  Count& count = seen_.counts[pass.name];
  ++count.dispatches;
  count.needed_barriers += referee_.needs_barrier();
  take_findings(pass, referee_);
  std::vector<Memory> first;
  for (Memory* memory : record.dispatch.buffers) first.push_back({memory->name, memory->words, {}});

  Referee fresh;
  Choices other_order;
  other_order.seed = 12345 + count.dispatches;
  const std::vector<Memory> second = record.repeat(fresh, other_order);
  take_findings(pass, fresh);

  issue();
  wait_for_device();
  std::vector<Memory> device;
  for (std::size_t k = 0; k < bound_.size(); ++k)
    device.push_back({first[k].name, download(bound_[k], first[k].name).words, {}});
  if (compares_) compare(record, first, second, device);
  record.steps = steps;
  keep(record);
}

/// What depends on the order of invocations, as a place in a list, may be other on the device.
void Recorder::compare(const Record& record, const std::vector<Memory>& first, const std::vector<Memory>& second,
                       const std::vector<Memory>& device) {
  const Pass& pass = record.pass;
  for (std::size_t k = 0; k < first.size(); ++k) {
    if (pass.module->buffers[k].readonly || !is_compared(pass.name, first[k].name)) continue;
    std::size_t others = 0, example = 0, free = 0, changed = 0;
    for (std::size_t w = 0; w < first[k].words.size(); ++w) {
      changed += first[k].words[w] != record.buffers[k].words[w];
      if (first[k].words[w] != second[k].words[w]) {
        ++free;
      } else if (!alike(first[k].words[w], device[k].words[w])) {
        if (others++ == 0) example = w;
      }
    }
    if (others > most_ties(pass.name, changed))
      add(pass.name + ": " + first[k].name + " is other than on the device in " + std::to_string(others) + " of " +
          std::to_string(changed) + " changed words (" + std::to_string(free) + " by order), as " +
          std::to_string(example) + ": " + std::to_string(as_float(first[k].words[example])) + " for " +
          std::to_string(as_float(device[k].words[example])));
  }
}

void Recorder::add(const std::string& finding) {
  if (std::find(seen_.findings.begin(), seen_.findings.end(), finding) == seen_.findings.end())
    seen_.findings.push_back(finding);
}

void Recorder::take_findings(const Pass& pass, Referee& referee) {
  for (const Finding& f : referee.findings())
    add(pass.name + ": " + f.kind + ": " + f.memory + ", " + pass.module->place_of(f.first) + " and " +
        pass.module->place_of(f.second));
  referee.forget_findings();
}

void Recorder::keep(const Record& record) {
  if (record.pass.module->barriers.empty()) return;
  std::string key = record.pass.name;
  const auto stage = record.dispatch.uniforms.find("stage");
  if (stage != record.dispatch.uniforms.end()) key += std::to_string(stage->second);
  if (++kept_[key] <= 3) seen_.records.push_back(record);
}

}  // namespace bin_scenes::races
