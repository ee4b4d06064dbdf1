/// Selects the contacts of a manifold from the candidates of a pair, at most eight. A selected contact that was there
/// in the last step starts with the forces of that step (warm start). The rule of selection is in
/// shaders/shared/sphere/choice.h, which the GPU form uses as well.
#pragma once

#include "solver/sphere/passes/candidates.hpp"

namespace bin_scenes::sphere {

#include "shared/sphere/choice.h"

/// Selects the few candidates that represent all (shared/sphere/choice.h).
/// @param old  manifold of the last step
/// @param size  size of the smaller part (m)
/// @param approach  predicted relative motion of the pair in this step
/// @param soon  candidates whose gap exceeds the smallest gap by no more than this are about to touch (m)
/// @param chosen  receives the indices of at most max_contacts candidates
void reduce(const Candidates& candidates, const Manifold& old, const Approach& approach, float size, float soon,
            std::vector<int>& chosen);

/// Copies the forces of the last step's contacts to the new ones: by feature, unless features mean other points now
/// (Manifold::found), and otherwise from the nearest contact with a similar normal.
/// @param near  largest distance of such contacts (m)
void carry_forces(const Manifold& old, std::vector<Contact>& fresh, float near);

}  // namespace bin_scenes::sphere
