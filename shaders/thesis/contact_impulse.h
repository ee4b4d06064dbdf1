// Impulse of one contact in one iteration: what the velocities, as they are, still ask for. In a contact alone it is
// eq 2.30 over k (eq 3.5). Where the thesis's text and mechanics part:
//  - Friction. Eq 2.30 applies mu j along the slip however small it is, and so turns a slow slip round in every
//    iteration. Here the tangential impulse is the one that stops the slip, and the sum over the iterations is kept
//    within Coulomb's cone: a sliding contact ends with mu j against the slip as in eq 2.30, a slow one sticks.
//  - Iterations. The sum, not each part, has to push: an iteration may take back what an earlier one gave too much
//    (accumulated impulses, Catto 2006, the paper the thesis takes its bias from).
//  - Restitution and bias. Eq 2.30 adds them, so a bounce that starts a little deep leaves faster than it came. Here
//    the larger of the two is the speed of separation to reach, set once before the iterations.
//  - Mass splitting. k counts one pair of bodies. Where each of a body's n neighbours sees the whole of its mass, their
//    impulses add up to more than is needed, and iterations drive a pile apart instead of solving it. Bodies n times as
//    light (Tonge, Benevolenski, Voroshilov 2012) cannot overshoot, but converge slowly; Jacobi iteration bears up to
//    twice that step. With one neighbour eq 3.5 holds as it is. docs/lab/thesis.md has the figures.
const float over_relaxation = 1.9;
float lighter(uint neighbours) { return max(1.0, float(neighbours) / over_relaxation); }

struct Side {
  vec3 position, velocity, spin;
  float inverse_mass;    // of the split body
  vec3 diagonal, mixed;  // inverse inertia xx yy zz, xy xz yz; of the split body
};
const Side still = Side(vec3(0.0), vec3(0.0), vec3(0.0), 0.0, vec3(0.0), vec3(0.0));

// Change of the side's velocity at `arm` by the impulse `p` there: the bracket of eq 2.30's divisor.
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
