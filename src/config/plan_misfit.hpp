/// Whether a plan's outputs can hold what one of its requests makes.
#pragma once

#include "bin_scenes/config/plan.hpp"
#include "bin_scenes/core/error.hpp"

#include <optional>

namespace bin_scenes::config {

/// Why they cannot; none: they can.
std::optional<Error> misfit(const Plan& plan, const Request& request);

}  // namespace bin_scenes::config
