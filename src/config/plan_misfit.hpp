/// Tests whether the output formats of a plan can represent what its requests produce, before any heap is poured. For
/// example, BOP cannot represent the distortion of a lens.
#pragma once

#include "bin_scenes/config/plan.hpp"
#include "bin_scenes/core/error.hpp"
#include "config/distribution.hpp"

#include <optional>

namespace bin_scenes::config {

/// Why they cannot; none: they can.
std::optional<Error> misfit(const Plan& plan, const Request& request);

/// Adds notes of what BOP's files leave out of the sensors' images, and where heaps may have more parts than
/// bop_toolkit keeps estimates of an image, so that truth that is submitted as estimates scores less than 1, unless
/// targets are limited. `parts`: of the key `amount`.
void note_losses(Plan& plan, const std::optional<Distribution>& parts);

}  // namespace bin_scenes::config
