/// What an instruction costs on a card of NVIDIA's Hopper generation, and the card that it is counted for.
///
/// Sources: [1] Luo et al., "Benchmarking and Dissecting the Nvidia Hopper GPU Architecture", arXiv:2402.13499, tables
/// of memory latency. [2] Jia et al., "Dissecting the NVIDIA Volta GPU Architecture via Microbenchmarking",
/// arXiv:1804.06826, table 4.1 (arithmetic latency). [3] bench/results/nvidia-h200/trial.txt, what this project
/// measured.
#pragma once

#include "races/module.hpp"

namespace bin_scenes::meter {

using races::Instruction;
using races::Word;

/// Cycles, unless stated otherwise.
struct Card {
  double clock_mhz = 1755;        ///< boost clock of the H100 and H200
  double multiprocessors = 132;   ///< of the H200
  double schedulers = 4;          ///< each issues one instruction of one warp a cycle
  std::size_t l1_bytes = 131072;  ///< of the 256 kB that a multiprocessor has, where the rest is shared memory

  double arithmetic = 4.5;      ///< [2] 4 for float; 5 where the result is a predicate
  double special = 24;          ///< square roots, divisions, sines: not published; [2] gives 20 to 40 for such code
  double shared = 29;           ///< [1] 29.0
  double l1 = 39;               ///< [1] 40.7 on the H100, 37.9 on the A100
  double l2 = 290;              ///< [1] 263 on the H100's near half; the mean of both halves is higher
  double local = 30;            ///< an array that is indexed at run time lies in local memory, in L1
  double shared_atomic = 70;    ///< assumed: a shared load, an operation, a store
  double buffer_atomic = 500;   ///< assumed: at L2, and back
  double branch = 14;           ///< assumed: from a condition to the first instruction behind it
  double barrier = 30;          ///< assumed: from the last warp's arrival until all go on
  double launch_us = 5;         ///< [3] a dispatch: update_sleep takes 12 to 20 us there and has 7 us of work
  double bytes_of_code = 27.6;  ///< an instruction of optimised SPIR-V: the two programs whose size [3] lists
};

struct Cost {
  float slots = 0;    ///< of a scheduler, for all lanes of a warp together
  float latency = 0;  ///< until the result can be read
};

/// Loads and stores of buffers and shared memory have their slots here; their latency depends on where the data is.
/// Slots follow what NVIDIA's compiler makes of such operations: a multiplication that an addition follows becomes one
/// instruction with it, so both count less than one; signs are free; a division is a reciprocal and corrections. A word
/// of a load or store counts one slot for its address, the check of its bounds and moves.
Cost cost_of(const Instruction& instruction, const Card& card);

bool is_atomic(Word code);

}  // namespace bin_scenes::meter
