// Selects the candidates of a pair that become contacts. The deepest candidate is first. Then, repeatedly, the one with
// the highest score is added. The score is high for candidates that are far from the selected ones in position and
// normal, that are deep, or that are about to touch. Contacts of the last step have a small advantage, so that the
// selection does not alternate from step to step. `size` is that of the smaller part (m).

const float TWIN = 1e-3f;    // share of `size`: candidates that are nearer to each other are the same contact
const float ALIKE = 0.9f;    // cosine between the normals of two contacts of which one may inherit the force of the
                             // other
const float SOON = 1e-3f;    // share of `size`: a gap that may close before contacts are found again
const float STRIKE = 0.02f;  // distance in a step / distance up to which contacts are kept: the contacts of a faster
                             // pair are found again; with 0.05, two of ten heaps of channel_u turn by up to 1.9 degrees
                             // under the referee

/// Distance (m) of a candidate from a selected one, in position and normal together.
INLINE float distance_between(IN(vec3) on_a, IN(vec3) normal, IN(vec3) chosen_on_a, IN(vec3) chosen_normal,
                              float size) {
  return length(on_a - chosen_on_a) + 0.3f * size * length(normal - chosen_normal);
}

// The gap that counts in the score: the amount by which it exceeds the smallest gap. On faces that are about to meet,
// all gaps are equal and none counts.
INLINE float gap_of(float separation, float least_separation) {
  return max(0.0f, separation - max(0.0f, least_separation));
}

// Bonus of a candidate in the score. A metre of depth counts eight times as much as a metre of distance, so that
// overlap is more important than the spread of the manifold.
INLINE float advantage_of(float separation, float gap, bool known, float size) {
  return 8.0f * max(0.0f, -separation) - 20.0f * gap + (known ? 0.05f * size : 0.0f);
}

// Weight of a candidate whose gap is larger than `soon`: it gets only a place that is left over. Without this, the edge
// on which a wheel comes down next would lose its place to a wall beside it and be detected only after the wheel has
// sunk in.
INLINE float worth_of(float gap, float soon, float size) {
  return 1.0f / (1.0f + max(0.0f, gap - soon) / (1e-4f * size));
}
