/// Detects jammed parts, which are held by contacts that squeeze them harder than gravity can.
///
/// The squeeze of a part is the smaller of the forces that press on it from two opposite sides. A part of a heap
/// carries at most about its own weight and that of the parts above it. A jammed part carries more, by the action of a
/// wedge or because shapes overlap that the solver cannot separate.
#pragma once

#include "bin_scenes/scene/report.hpp"
#include "bin_scenes/solver/solver.hpp"

#include <vector>

namespace bin_scenes {

/// The ratio from which a scene has the flag part_jammed.
constexpr double flagged_squeeze = 10.0;

/// Finds the part with the largest ratio of its squeeze to the weight of itself and of all higher parts that it
/// touches, directly or through others.
JamReport worst_jam(const WorldDef& world, const std::vector<BodyState>& states,
                    const std::vector<ContactForce>& forces);

std::vector<Flag> flags_of(const JamReport& jam);

}  // namespace bin_scenes
