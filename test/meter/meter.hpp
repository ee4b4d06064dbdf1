/// Counts what compute passes cost on a card, without one: dispatches run in the interpreter of test/races, 32 lanes in
/// lockstep, with the costs of costs.hpp. docs/develop/gpu.md says how good the figures are.
#pragma once

#include "meter/costs.hpp"
#include "meter/counts.hpp"
#include "races/run.hpp"

namespace bin_scenes::meter {

/// Runs the dispatch, whose buffers are afterwards as a device would leave them, and adds its cost to `counts`. Its
/// module must have been compiled with Optimise::yes.
void measure(const races::Dispatch& dispatch, const Card& card, Counts& counts);

/// How long a card takes to issue the instructions of so many worlds, if each scheduler issues in every cycle (us).
double full_issue_us(double slots, double worlds, const Card& card);

}  // namespace bin_scenes::meter
