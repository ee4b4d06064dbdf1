// How deep two bodies overlap at a contact. The depth of a contact along its normal leads to the face through which a
// part is pressed out. That face can be far beyond the nearest surface: where the flanks of two teeth overlap by 2 % of
// d, it can be 7 % of d away.
//
// The includer defines before: field.h, and Placed with the members field, rotation (mat3, from body axes to the bin
// frame) and position (centre of mass, bin frame, m).

// Returns the distance (m, negative inside) of a point from a body, and the unit gradient; both in the bin frame.
INLINE float distance_from(IN(Placed) body, IN(vec3) point, OUT(vec3) away) {
  vec3 local;
  float distance = sample_field(body.field, turned_back(body.rotation, point - body.position), local);
  away = body.rotation * local;
  return distance;
}

// Returns the depth (m, not negative) of a contact whose points on_a and on_b (m, bin frame) are on the surfaces of
// both bodies: the larger one of the depth of a point of one body in the other one and of the diameter of the largest
// ball within both bodies, which is searched from the middle between the points (steps along the gradient of the field
// that is less deep). It is at most `depth`, the depth along the normal.
INLINE float overlap_at(IN(Placed) a, IN(Placed) b, IN(vec3) on_a, IN(vec3) on_b, float depth) {
  const int most_steps = 16;
  vec3 away_a, away_b, at = 0.5f * (on_a + on_b);
  float overlap = max(-distance_from(b, on_a, away_b), -distance_from(a, on_b, away_a));
  for (int i = 0; i < most_steps; ++i) {
    float from_a = distance_from(a, at, away_a), from_b = distance_from(b, at, away_b);
    overlap = max(overlap, -2.0f * max(from_a, from_b));
    vec3 away = away_b;
    if (from_a > from_b) away = away_a;
    at -= 1.0f / float(most_steps) * depth * away;
  }
  return max(min(overlap, depth), 0.0f);
}
