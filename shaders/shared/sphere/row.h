// Where a contact's levers, its normal and its gap are of, while it is solved. Levers and normals are of the mean of
// the sub-steps' beginnings: those of the step's start turn what hangs into what gains energy (a yoke on a ridge 8 % a
// second), with those of the middle of the whole step it loses as much.

const float LEAST_TURN = 1e-5f;  // rad; below, a lever moves by less than contacts overlap

// Takes the levers and the normal of the step's start half way through it, by displacement (m) and turn (rad) of both
// bodies. The point goes with the sample, the normal with the field; of_a: the field is a's.
INLINE void go_half_way(bool of_a, IN(vec3) moved_a, IN(vec3) turn_a, IN(vec3) moved_b, IN(vec3) turn_b, INOUT(vec3) ra,
                        INOUT(vec3) rb, INOUT(vec3) normal) {
  if (max(dot(turn_a, turn_a), dot(turn_b, turn_b)) <= LEAST_TURN * LEAST_TURN) return;
  vec3 moved = of_a ? vec3(moved_b + cross(turn_b, rb)) : vec3(moved_a + cross(turn_a, ra));
  ra += moved - moved_a;
  rb += moved - moved_b;
  normal = unit(normal + cross(of_a ? turn_a : turn_b, normal));
}

// Levers of one common point of what is hit, of where the bodies' centres of mass x are now and the contact's points
// with them: with those of half way through the step an impact would turn each of two bodies about a lever that is up
// to half a step's displacement off, and change their common angular momentum.
INLINE void levers_now(IN(vec3) x_a, IN(vec3) on_a, IN(vec3) x_b, IN(vec3) on_b, IN(vec3) normal, OUT(vec3) ra,
                       OUT(vec3) rb, OUT(float) gap) {
  vec3 between = on_b - on_a, middle = on_a + 0.5f * between;
  ra = middle - x_a;
  rb = middle - x_b;
  gap = dot(between, normal);
}
