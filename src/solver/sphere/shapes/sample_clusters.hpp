/// Sorts nodes into clusters of 16 neighbours, and computes the bounding sphere of each cluster. One value of a
/// distance field then rejects all nodes of a cluster at once, which is what happens to most of them in a step.
#pragma once

#include "solver/sphere/shapes/sample_draft.hpp"

namespace bin_scenes::sphere {

/// Returns the samples in the body frame. `center`: centre of mass (model frame, m); `spacing`: of edges (m).
Samples clustered(Draft draft, const Vec3& center, double spacing);

/// Makes the members of Samples that repeat others in another order: nodes and cluster centres by component (the last
/// point also fills the unused places at the end), and the edges of each node.
void lay_out(Samples& samples);

}  // namespace bin_scenes::sphere
