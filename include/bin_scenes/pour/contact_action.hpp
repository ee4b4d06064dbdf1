/// Decides what each contact of a trace does: whether it rests, slides, is pushed apart, or is an impact. The decision
/// uses poses, velocities and forces only, so that it is the same for all solvers. It is meant for looking at, and
/// never influences a simulation.
#pragma once

#include "bin_scenes/part/loaded_request.hpp"
#include "bin_scenes/scene/scene.hpp"
#include "bin_scenes/solver/solver.hpp"

#include <vector>

namespace bin_scenes {

/// Converts the contact forces of a solver to contacts of a scene, with their actions. All limits are relative to d,
/// the diagonal of the smaller part. The first action that applies is taken:
///
/// impact: the bodies approached each other at this point in the previous sample, or separate now, faster than after a
/// fall by 1 % of d; pushed_apart: the surfaces overlap by more than 0.1 % of d; sliding: the surfaces move along each
/// other by more than 5 % of d per second; resting: all others.
/// @param before  states of all bodies in the previous sample; empty in the first one
/// @param now     states of all bodies at the time of the forces
std::vector<SceneContact> contacts_of(const std::vector<ContactForce>& forces, const std::vector<BodyState>& before,
                                      const std::vector<BodyState>& now, const LoadedRequest& loaded);

}  // namespace bin_scenes
