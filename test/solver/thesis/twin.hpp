/// CPU twins of the passes in shaders/thesis: slow, simple and single-threaded. They specify what a pass computes, and
/// the tests compare the passes with them. Each twin works on Memory as its pass works on the buffers.
#pragma once

#include "solver/thesis/memory.hpp"

namespace bin_scenes::thesis::twin {

void begin_step(Memory& memory);
void force(Memory& memory);
void move_to_world(Memory& memory);
void count_cells(Memory& memory);
void prefix_sum(Memory& memory);
void scatter(Memory& memory);
void reorder(Memory& memory);
void detect(Memory& memory);
void plan(Memory& memory);
void count_pairs(Memory& memory);
void split_mass(Memory& memory);
void impulse(Memory& memory);
void pre_velocity(Memory& memory);
void velocity(Memory& memory);
void position(Memory& memory);

}  // namespace bin_scenes::thesis::twin
