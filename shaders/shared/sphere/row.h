// Lever arms and normals of contacts at the time for which they are solved. This contact time is the mean of the times
// at which the sub-steps begin (StepPlan::contact_time). Lever arms and normals of the start of the step would add
// energy to hanging parts (for a yoke on a ridge 8 % per second), and those of the middle of the step would remove as
// much.

const float LEAST_TURN = 1e-5f;  // rad: after less rotation, lever arms and normals stay as they are

// Displacement (m) and rotation vector (rad) of a body from the start of the step to the contact time.
struct Ahead {
  vec3 moved, turned;
};

// Moves the lever arms ra, rb (m) and the normal from the start of the step to the contact time. The contact point
// moves with the sample's body, and the normal with the body of the field; of_a: the field belongs to a.
INLINE void move_to_contact_time(bool of_a, IN(Ahead) a, IN(Ahead) b, INOUT(vec3) ra, INOUT(vec3) rb,
                                 INOUT(vec3) normal) {
  if (max(dot(a.turned, a.turned), dot(b.turned, b.turned)) <= LEAST_TURN * LEAST_TURN) return;
  vec3 moved = of_a ? vec3(b.moved + cross(b.turned, rb)) : vec3(a.moved + cross(a.turned, ra));
  ra += moved - a.moved;
  rb += moved - b.moved;
  normal = unit(normal + cross(of_a ? a.turned : b.turned, normal));
}

// Computes the lever arms of an impact for one common point, from the present centres of mass x and contact points. The
// lever arms of the contact time would be wrong by up to half a step's displacement: the impulses on both bodies would
// act at different points and change the total angular momentum. Returns the vector from the point on a to that on b.
INLINE vec3 levers_now(IN(vec3) x_a, IN(vec3) on_a, IN(vec3) x_b, IN(vec3) on_b, OUT(vec3) ra, OUT(vec3) rb) {
  vec3 between = on_b - on_a, center = on_a + 0.5f * between;
  ra = center - x_a;
  rb = center - x_b;
  return between;
}
