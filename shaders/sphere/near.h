// Determines which contacts of a manifold may press in a sub-step. Half of all contacts in a heap cannot: the gaps are
// wider than a sub-step can close. Sweeps leave them out, which does not change results by a single bit, because their
// impulses are 0 before and after. This is certain while the highest speed at which the two bodies can approach each
// other, times the length of a sub-step, is below the smallest of these gaps (SphereOrdered.slack). The bound of the
// speed grows with each impulse at the manifold's other contacts (SphereOrdered.yield).

const float NO_LIMIT = 3e38;
const float REACH_MARGIN = 1.001;  // factor on the bounds below, for rounding errors
const float NEAR_REACH = 1.5;      // contacts are near up to a gap of this factor x the displacement in a sub-step;
                                   // with less, all contacts are solved more often; with more, some in vain

// Returns an upper bound (1/kg) of the speed along one normal that a unit impulse along another normal causes. `mass`:
// smallest effective mass of a contact (kg). The matrix of these speeds is symmetric and positive semidefinite, so that
// no element is larger than the largest one on the diagonal.
float yield_of(float mass) { return REACH_MARGIN / mass; }

// Returns an upper bound of the speed (m/s) or displacement (m) at a contact along any normal, from the bodies' motion.
float reach_of(vec3 between, vec3 turn_a, vec3 turn_b, float arm) {
  return REACH_MARGIN * (length(between) + arm * (length(turn_a) + length(turn_b)));
}
