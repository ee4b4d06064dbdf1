// Selects the candidates of a pair that become contacts. The deepest candidate is first. Then, repeatedly, the one with
// the highest score is added. The score is high for candidates that are far from the selected ones in position and
// normal, that are deep, or that are about to touch. Contacts of the last step have a small advantage, so that the
// selection does not alternate from step to step. `size` is that of the smaller part (m).

const float TWIN = 1e-3f;    // size: as near as that is the same contact
const float ALIKE = 0.9f;    // cosine of normals of contacts that may hand their force on
const float SOON = 1e-3f;    // size: a gap that may close before contacts are found anew
const float STRIKE = 0.02f;  // distance in a step / that for which contacts are kept: what strikes as fast is found
                             // anew; with 0.05 two of ten heaps of channel_u turn by up to 1.9 degrees under the
                             // referee

INLINE float way_between(IN(vec3) on_a, IN(vec3) normal, IN(vec3) chosen_on_a, IN(vec3) chosen_normal, float size) {
  return length(on_a - chosen_on_a) + 0.3f * size * length(normal - chosen_normal);
}

// A gap counts by what it is wider than the least: of faces that are about to meet, all is as far away.
INLINE float gap_of(float separation, float least_separation) {
  return max(0.0f, separation - max(0.0f, least_separation));
}

// Depth counts like distance, seen through a long lens: an overlap matters before the spread of the manifold.
INLINE float advantage_of(float separation, float gap, bool known, float size) {
  return 8.0f * max(0.0f, -separation) - 20.0f * gap + (known ? 0.05f * size : 0.0f);
}

// What is farther off than `soon` gets the places that are left: for a wall beside it, the edge that a wheel comes down
// on next would not be seen before it has sunk in.
INLINE float worth_of(float gap, float soon, float size) {
  return 1.0f / (1.0f + max(0.0f, gap - soon) / (1e-4f * size));
}
