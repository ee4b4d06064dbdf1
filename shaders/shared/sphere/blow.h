// What tells a blow from a force: a force may grow by half in a sub-step, and by what stops blow_speed(). Beyond, the
// impulse was that of a blow: it is over, and the next sub-step does not begin with it. A few sweeps do not take it
// back from a heap, which would be thrown up.

const float FORCE_GROWTH = 1.5f;  // more = heaps rebound, less = loads of a deep heap are found later

// Speed (m/s) that a force may take from its bodies in the first sub-step of its life. `weight`: m/s2.
INLINE float blow_speed(float sub_step, float weight, float restitution_speed) {
  float falls = 4.0f * sub_step * weight;
  return falls > 0.0f ? min(falls, restitution_speed) : restitution_speed;
}
