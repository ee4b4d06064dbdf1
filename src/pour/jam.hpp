/// Parts that are held by contacts which squeeze them harder than gravity can: they do not lie, they stick.
///
/// What presses on a part from one side and from the other, the smaller of both, is its squeeze. A part that lies in a
/// heap carries at most about the weight of what is above it, and its own. A jam carries more, by a wedge's action or
/// because shapes overlap which the solver cannot push apart.
#pragma once

#include "bin_scenes/scene/report.hpp"
#include "bin_scenes/solver/solver.hpp"

#include <vector>

namespace bin_scenes {

/// Ratio from which a scene carries the flag part_jammed.
constexpr double flagged_squeeze = 10.0;

/// The part that is squeezed most, for its own weight and that of all it touches, directly or not, that is higher.
/// Nothing without gravity.
JamReport worst_jam(const WorldDef& world, const std::vector<BodyState>& states,
                    const std::vector<ContactForce>& forces);

std::vector<Flag> flags_of(const JamReport& jam);

}  // namespace bin_scenes
