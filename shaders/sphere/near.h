// Which contacts of a manifold may press. Half of all contacts in a heap do not: their gaps are wider than a sub-step
// can close. Sweeps leave them out, and results stay the same to the last bit, because the impulse of such a contact is 0
// before and after. That is certain while the speed at which the two bodies can approach each other at any contact,
// times the length of a sub-step, is below the least of those gaps (SphereOrdered.slack). The bound of that speed grows
// with each impulse of the manifold's other contacts (SphereOrdered.yield).

const float NO_LIMIT = 3e38;
const float REACH_MARGIN = 1.001;  // rounding of the bounds below
const float NEAR_REACH = 1.5;      // gaps within so many times what a sub-step may close are near: with less, all contacts
                                   // have to be solved more often, with more, a few are always solved in vain

// Most by which an impulse along the normal of one contact changes the speed along that of another (1/kg), if the smallest
// effective mass of a contact is `mass`: the matrix of all such changes is symmetric and has no negative eigenvalue, so
// that no entry is larger than the largest of its diagonal.
float yield_of(float mass) { return REACH_MARGIN / mass; }

// Highest speed (m/s) or displacement (m) along any normal, from those of the centres of mass and of turns.
float reach_of(vec3 between, vec3 turn_a, vec3 turn_b, float arm) {
  return REACH_MARGIN * (length(between) + arm * (length(turn_a) + length(turn_b)));
}
