// The pose at which the lever arms, the normal and the gap of a contact are evaluated while it is solved. Lever arms
// and normals belong to the mean of the times at which the sub-steps begin. Those of the start of the step would add
// energy to hanging parts (for a yoke on a ridge 8 % per second), and those of half of the whole step would remove as
// much.

const float LEAST_TURN = 1e-5f;  // rad; below, a lever moves by less than contacts overlap

// How far a body is (m, rad) halfway through the step from where it started.
struct Ahead {
  vec3 moved, turned;
};

// Takes the levers and the normal of the step's start halfway through it. The point goes with the sample, the normal
// with the field; of_a: the field is a's.
INLINE void go_half_way(bool of_a, IN(Ahead) a, IN(Ahead) b, INOUT(vec3) ra, INOUT(vec3) rb, INOUT(vec3) normal) {
  if (max(dot(a.turned, a.turned), dot(b.turned, b.turned)) <= LEAST_TURN * LEAST_TURN) return;
  vec3 moved = of_a ? vec3(b.moved + cross(b.turned, rb)) : vec3(a.moved + cross(a.turned, ra));
  ra += moved - a.moved;
  rb += moved - b.moved;
  normal = unit(normal + cross(of_a ? a.turned : b.turned, normal));
}

// Levers of one common point of what is hit, of where the bodies' centres of mass x are now and the contact's points
// with them: with those of halfway through the step an impact would turn each of two bodies about a lever that is up
// to half a step's displacement off, and change their common angular momentum. Returns what lies between the points.
INLINE vec3 levers_now(IN(vec3) x_a, IN(vec3) on_a, IN(vec3) x_b, IN(vec3) on_b, OUT(vec3) ra, OUT(vec3) rb) {
  vec3 between = on_b - on_a, center = on_a + 0.5f * between;
  ra = center - x_a;
  rb = center - x_b;
  return between;
}
