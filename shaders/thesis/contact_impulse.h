// Computes the impulse of one contact in one iteration from the present velocities. For a single contact, it is eq 2.30
// of the thesis divided by k (eq 3.5). The code deviates from the thesis where its equations contradict mechanics:
//  - Friction. Eq 2.30 applies the impulse mu j against the slip however slow it is, and thus reverses a slow slip
//    in each iteration. Here the tangential impulse stops the slip, and its sum over the iterations is limited to
//    Coulomb's cone: a sliding contact ends with mu j against the slip as in eq 2.30, and a slow one sticks.
//  - Iterations. Only the sum of the impulses must not pull: an iteration may reduce the impulse of an earlier one
//    (accumulated impulses, Catto 2006, from which the thesis has its bias velocity).
//  - Restitution and bias. Eq 2.30 adds them, so that a rebound from an overlap is faster than the impact. Here the
//    larger of the two is the speed of separation to reach; it is determined once before the iterations.
//  - Mass splitting. k counts the contacts of one pair. If each of the n neighbours of a body uses its whole mass, the
//    sum of their impulses is too large, and the iterations push a heap apart. With bodies n times as light (Tonge,
//    Benevolenski, Voroshilov 2012), they cannot overshoot but converge slowly; Jacobi iteration is stable up to twice
//    that step. With one neighbour, eq 3.5 holds unchanged. docs/lab/thesis.md has measurements.
const float over_relaxation = 1.9;
float lighter(uint neighbours) { return max(1.0, float(neighbours) / over_relaxation); }

struct Side {
  vec3 position, velocity, spin;
  float inverse_mass;    // 1/kg, after mass splitting
  vec3 diagonal, mixed;  // inverse inertia tensor (1/(kg m2)), after mass splitting: xx yy zz, and xy xz yz
};
const Side still = Side(vec3(0.0), vec3(0.0), vec3(0.0), 0.0, vec3(0.0), vec3(0.0));

// Returns the change of a body's velocity at the point `arm` by an impulse `p` there (bracket in eq 2.30's divisor).
vec3 response(Side side, vec3 arm, vec3 p) {
  return side.inverse_mass * p + cross(symmetric_times(side.diagonal, side.mixed, cross(arm, p)), arm);
}

vec3 contact_impulse(ThesisContact contact, Side own, Side other, vec3 other_arm) {
  vec3 n = contact.normal.xyz, arm = contact.arm.xyz;
  float friction = contact.arm.w, goal = contact.total.w, k = float(contact.other.z);
  vec3 v = (own.velocity + cross(own.spin, arm)) - (other.velocity + cross(other.spin, other_arm));
  float vn = dot(n, v);

  float along_n = dot(n, response(own, arm, n) + response(other, other_arm, n));
  float push = max(0.0, dot(n, contact.total.xyz) + (goal - vn) / (along_n * k));

  vec3 tangent = contact.total.xyz - dot(n, contact.total.xyz) * n;
  vec3 slip = v - vn * n;
  float speed = length(slip);
  if (speed > 1e-9) {
    vec3 t = slip / speed;
    tangent -= slip / (dot(t, response(own, arm, t) + response(other, other_arm, t)) * k);
  }
  float size = length(tangent);
  if (size > friction * push) tangent *= friction * push / size;
  return push * n + tangent - contact.total.xyz;
}
