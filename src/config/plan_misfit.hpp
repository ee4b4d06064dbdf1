/// Tests whether the output formats of a plan can represent what its requests produce, before any heap is poured. For
/// example, BOP cannot represent the distortion of a lens.
#pragma once

#include "bin_scenes/config/plan.hpp"
#include "bin_scenes/core/error.hpp"
#include "config/distribution.hpp"

#include <optional>

namespace bin_scenes::config {

/// Returns the reason why the output formats of `plan` cannot represent the scenes of `request`; empty if they can.
std::optional<Error> misfit(const Plan& plan, const Request& request);

/// Adds notes to the plan: which content of the images the BOP files cannot hold, and whether a heap may have more
/// parts than bop_toolkit keeps estimates per image. In this case the true poses score below 1, unless the targets are
/// limited. `parts` is the distribution of the number of parts, from the key `amount`.
void note_losses(Plan& plan, const std::optional<Distribution>& parts);

}  // namespace bin_scenes::config
