/// Sorts nodes into clusters of 16 neighbours, and computes the bounding sphere of each cluster. One value of a
/// distance field then rejects all nodes of a cluster at once, which is what happens to most of them in a step.
#pragma once

#include "solver/sphere/shapes/sample_draft.hpp"

namespace bin_scenes::sphere {

/// In the body frame: `center` is the centre of mass in model axes (m); `spacing` that of the draft's edges (m).
Samples clustered(Draft draft, const Vec3& center, double spacing);

/// Points by component, from nodes and clusters; the last point fills up what is left of a bunch.
void lay_out(Samples& samples);

}  // namespace bin_scenes::sphere
