/// Which registers an instruction reads and writes: what its result has to wait for.
#pragma once

#include "races/module.hpp"

#include <vector>

namespace bin_scenes::meter {

using races::Instruction;
using races::Module;
using races::Word;

struct Flow {
  std::vector<Word> reads, writes;
};

/// Of an instruction that is no copy and no OpPhi: these only move when a word is ready.
Flow flow_of(const Instruction& instruction, const Module& module);

}  // namespace bin_scenes::meter
