/// From the candidates of a pair to its manifold: which contacts stand for all, and the forces they begin with.
#pragma once

#include "solver/sphere/passes/candidates.hpp"

namespace bin_scenes::sphere {

/// The few contacts that stand for all: the deepest, then again and again the one farthest from those chosen, in
/// position and normal alike, deep ones preferred, and what is about to touch to what is farther off; contacts of the
/// last step have a small advantage, so that the choice does not flicker.
/// @param old  manifold of the last step
/// @param size  of the smaller part (m)
/// @param soon  gap beyond the least up to which is about to touch (m)
/// @param chosen  indices of at most max_contacts candidates
void reduce(const Candidates& candidates, const Manifold& old, float size, float soon, std::vector<int>& chosen);

/// Forces of the last step's contacts: by feature, else from the nearest with a like normal.
/// @param near  how far apart such contacts may lie (m)
void carry_forces(const std::vector<Contact>& old, std::vector<Contact>& fresh, float near);

}  // namespace bin_scenes::sphere
