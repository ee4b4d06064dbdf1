/// Instructions that compute, on the registers of one invocation.
#pragma once

#include "races/module.hpp"

namespace bin_scenes::races {

/// False if it is not an instruction that computes.
bool compute(const Instruction& i, Word* registers);

/// Functions of GLSL.std.450.
void compute_extended(const Instruction& i, Word* registers);

}  // namespace bin_scenes::races
