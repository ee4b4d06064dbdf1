/// A dispatch of a pass, one instruction of one invocation after the other. Between barriers the invocations of a group
/// take their turns in random order, and so do the groups.
#pragma once

#include "races/module.hpp"
#include "races/referee.hpp"

#include <array>
#include <limits>
#include <map>

namespace bin_scenes::races {

/// What a pass is dispatched with.
struct Dispatch {
  const Module* module = nullptr;
  std::array<Word, 3> groups{1, 1, 1};
  std::map<std::string, Word> uniforms;  ///< bits
  std::vector<Memory*> buffers;          ///< by BufferVariable
};

constexpr Word none = std::numeric_limits<Word>::max();

struct Choices {
  std::uint64_t seed = 1;  ///< of the order
  Word without = none;     ///< the barrier, of Module::barriers, that is left out
  std::uint64_t most_steps = 400'000'000;
  bool stop_at_first = false;  ///< when something is found
};

struct Outcome {
  std::uint64_t steps = 0;  ///< instructions
  bool left_out = false;    ///< an invocation came to the barrier that is left out
};

Outcome run(const Dispatch& dispatch, Referee& referee, const Choices& choices = {});

}  // namespace bin_scenes::races
