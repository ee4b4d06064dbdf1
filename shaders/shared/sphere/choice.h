// Selects the candidates of a pair that become contacts. The deepest candidate is first. Then, repeatedly, the one with
// the highest score is added. The score is high for candidates that are far from the selected ones in position and
// normal, that are deep, or that are about to touch. Contacts of the last step have a small advantage, so that the
// selection does not alternate from step to step. `size` is that of the smaller part (m).

const float TWIN = 1e-3f;    // share of `size`: candidates that are nearer to each other count as one contact
const float ALIKE = 0.9f;    // smallest cosine of the angle between the normals of a contact and a contact of the last
                             // step whose force it inherits
const float SOON = 1e-3f;    // share of `size`: a smaller gap may close before the contacts are found again
const float STRIKE = 0.02f;  // share of the recycling limit: contacts of a pair that has moved farther, and
                             // that moves farther in this step, are found again; with 0.05, two of ten heaps of
                             // channel_u turn by up to 1.9 degrees under the referee

/// Returns the distance (m) of a candidate from a selected one: distance of positions + 0.3 size x distance of normals.
INLINE float distance_between(IN(vec3) on_a, IN(vec3) normal, IN(vec3) chosen_on_a, IN(vec3) chosen_normal,
                              float size) {
  return length(on_a - chosen_on_a) + 0.3f * size * length(normal - chosen_normal);
}

// The motion of b relative to a that is predicted for this step (m, rad), in the frame of a.
struct Approach {
  vec3 drift, twist;
};

// Returns the gap (m) that lowers the score of a candidate: the amount by which its separation exceeds the smallest
// separation of the pair. On faces that are about to meet, all gaps are equal, and the result is 0. A gap that closes
// fast, within this step, lowers the score little: otherwise, a wall along which a part falls would replace the edge on
// which the part lands.
INLINE float gap_of(IN(Approach) approach, IN(vec3) on_a, IN(vec3) normal, float separation, float least_separation,
                    float size) {
  const float of_closing = 0.01f;
  float nearing = -dot(normal, approach.drift + cross(approach.twist, on_a));
  float gap = max(0.0f, separation - max(0.0f, least_separation));
  return nearing > max(separation, SOON * size) ? of_closing * gap : gap;
}

// Returns the bonus (m) of a candidate in the score. A metre of depth counts eight times as much as a metre of distance
// from the selected candidates, so that overlap is more important than the spread of the manifold.
INLINE float advantage_of(float separation, float gap, bool known, float size) {
  return 8.0f * max(0.0f, -separation) - 20.0f * gap + (known ? 0.05f * size : 0.0f);
}

// Returns the factor (0 to 1) of the score. It is small if the gap exceeds `soon` (m), so that such a candidate is
// selected last. Without it, a candidate at a wall beside a wheel would replace that of the edge on which the wheel
// comes down next.
INLINE float worth_of(float gap, float soon, float size) {
  return 1.0f / (1.0f + max(0.0f, gap - soon) / (1e-4f * size));
}
