/// Start poses that the default solver cannot hold: a part without friction under a much heavier one. They are refused
/// before the simulation starts; other heavy loads are simulated.
#pragma once

#include "pour/pour_plan.hpp"

namespace bin_scenes {

/// Throws an input Error that names both parts if a given part stands on a lighter one that friction does not hold, and
/// the ratio R of their masses is too large. Contacts yield a little under a load, so that the heavy part tilts if the
/// light one is not exactly below its centre. The light one is then accelerated by R g times this angle: its
/// displacement grows at a rate of 1.5 R g h / L (1/s; h: sub-step, L: its width). In the exact solution it would stay.
void refuse_squeezed_parts(const PourPlan& plan);

}  // namespace bin_scenes
