/// Sorts nodes into clusters, and computes the bounding sphere of each cluster, with which all of its nodes are
/// rejected together.
#pragma once

#include "solver/sphere/shapes/sample_draft.hpp"

namespace bin_scenes::sphere {

/// In the body frame: `center` is the centre of mass in model axes (m); `spacing` that of the draft's edges (m).
Samples clustered(Draft draft, const Vec3& center, double spacing);

/// Points by component, from nodes and clusters; the last point fills up what is left of a bunch.
void lay_out(Samples& samples);

}  // namespace bin_scenes::sphere
