// One contact in the solve (sequential impulses, Catto 2005, "Iterative dynamics with temporal coherence"; soft
// contacts, Catto 2024, "Solver2D"). Impulses are those of one sub-step (N s). Speeds are those of b relative to a
// along the normal (m/s), positive if the bodies separate. Gaps are in m, negative where the bodies overlap. In C++,
// Real is a vector of eight contacts (lanes.hpp).
#ifndef SHARED_SPHERE_CONTACT_H
#define SHARED_SPHERE_CONTACT_H

// The compliance of contacts in one sweep.
struct Give {
  float sub_step;                         // length of a sub-step (s)
  float rate, mass_share, impulse_share;  // coefficients of an implicit spring: bias rate (1/s), and factors (0 to 1)
  float slop, push_speed;                 // overlap that is not removed (m), largest speed of removing overlap (m/s)
};

// Returns the compliance in the sweeps before bodies move, which remove overlap like a spring. rate: frequency of the
// spring / frequency of sub-steps.
INLINE Give softly(float sub_step, float rate, float damping_ratio, float slop, float push_speed) {
  float omega = 6.2831853f * rate / sub_step, a1 = 2.0f * damping_ratio + sub_step * omega;
  float a2 = sub_step * omega * a1, a3 = 1.0f / (1.0f + a2);
  Give give;
  give.sub_step = sub_step;
  give.rate = omega / a1;
  give.mass_share = a2 * a3;
  give.impulse_share = a3;
  give.slop = slop;
  give.push_speed = push_speed;
  return give;
}

// Returns the compliance in the sweeps after bodies have moved, which remove the velocity that the removal of overlap
// has caused (relaxation).
INLINE Give firmly(float sub_step) {
  Give give;
  give.sub_step = sub_step;
  give.rate = give.impulse_share = give.slop = give.push_speed = 0.0f;
  give.mass_share = 1.0f;
  return give;
}

// Returns the effective mass (kg) of a contact along a direction. moment: lever arm x direction (m); turn: inverse
// inertia times moment, the change of angular velocity by a unit impulse.
INLINE Real effective_mass(Real inverse_masses, IN(Real3) moment_a, IN(Real3) turn_a, IN(Real3) moment_b,
                           IN(Real3) turn_b) {
  Real k = inverse_masses + dot(moment_a, turn_a) + dot(moment_b, turn_b);
  return select(k > 0.0f, 1.0f / k, all_lanes(0.0f));
}

// Returns the normal speed at which a contact closes its gap, if it closes with `speed` (below 0) at the start of the
// step. Gravity accelerates the bodies until then, so that a rebound returns exactly the energy of the fall.
INLINE Real speed_at_impact(Real speed, Real gap, Real acceleration) {
  Real square = speed * speed - 2.0f * acceleration * max(gap, all_lanes(0.0f));
  return select(speed < 0.0f, -sqrt(max(square, all_lanes(0.0f))), speed);
}

// Returns the normal impulse (N s) after a sweep. A contact with a gap lets the bodies close it but does not pull.
INLINE Real normal_impulse(Real before, Real speed, Real gap, Real mass, IN(Give) give) {
  Mask apart = gap > 0.0f;
  Real push = max(give.rate * min(gap + give.slop, all_lanes(0.0f)), all_lanes(-give.push_speed));
  Real wanted = speed + select(apart, gap / give.sub_step, push);
  Real mass_share = select(apart, all_lanes(1.0f), all_lanes(give.mass_share));
  Real impulse_share = select(apart, all_lanes(0.0f), all_lanes(give.impulse_share));
  Real change = -mass * mass_share * wanted - impulse_share * before;
  return max(before + change, all_lanes(0.0f));
}

// Returns whether a contact whose impulse a sweep changed by `change` (N s) needs another sweep. tolerance: m/s.
INLINE Mask is_unconverged(Real change, Real mass, float tolerance) {
  return max(change, -change) > tolerance * mass;
}

// Limits the friction impulses f1 and f2 (N s) along two tangents to Coulomb's cone. most: coefficient of friction
// times the normal impulse (N s).
INLINE void put_into_cone(Real most, INOUT(Real) f1, INOUT(Real) f2) {
  Real size = sqrt(f1 * f1 + f2 * f2);
  Real share = select(size > most, most / size, all_lanes(1.0f));
  f1 *= share;
  f2 *= share;
}

// Returns whether a contact presses and slides: its friction has the limit `most` (N s) of Coulomb's cone.
INLINE Mask slips(Real most, Real f1, Real f2) {
  return (most > 0.0f) AND(f1 * f1 + f2 * f2 > 0.999f * most * most);
}

// The rule that distinguishes an impact from a lasting force. In one sub-step, a force may grow by half, and in
// addition by the impulse that stops impact_speed(). An impulse beyond that belongs to an impact, which is over, so
// that the next sub-step does not start with it. Otherwise, a few sweeps could not remove all of it from a heap,
// and the rest would throw parts upwards.
const float FORCE_GROWTH = 1.5f;  // largest ratio of forces in successive sub-steps; with more, heaps rebound; with
                                  // less, the loads of a deep heap are found later

// Returns the speed (m/s) that a new contact may stop in its first sub-step without counting as an impact. `weight`:
// acceleration (m/s2).
INLINE float impact_speed(float sub_step, float weight, float restitution_speed) {
  float falls = 4.0f * sub_step * weight;
  return falls > 0.0f ? min(falls, restitution_speed) : restitution_speed;
}

// Returns the share of an impulse that the next sub-step starts with. lasting: impulse at the start of this one (N s).
INLINE Real lasting_share(Real impulse, Real lasting, Real mass, float impact_speed) {
  Real most = FORCE_GROWTH * lasting + impact_speed * mass;
  return select(impulse > most, most / impulse, all_lanes(1.0f));
}

// Returns whether a contact was hit fast enough to bounce: it has pressed, or it would have closed in this sub-step if
// neighbouring contacts had not stopped the bodies. approach: m/s, negative.
INLINE Mask was_hit(Real approach, Mask pressed, Real gap, float sub_step, float restitution_speed) {
  return (approach <= -restitution_speed) AND(pressed OR(gap < -approach * sub_step));
}

// Returns the normal impulse (N s) after which the separating speed is restitution x approach speed (Newton's law).
INLINE Real bounced_impulse(Real before, Real speed, Real mass, Real restitution, Real approach) {
  return max(before - mass * (speed + restitution * approach), all_lanes(0.0f));
}

// Returns mean speed in a sub-step / speed at its end, for a body that friction brakes steadily. It is 1 for a body
// that is hit, or that is so slow that friction stops it in the sub-step. before, after: speeds (m/s).
INLINE float mean_share(float before, float after) {
  return after > 0.5f * before && after < 2.0f * before ? 0.5f * (before / after + 1.0f) : 1.0f;
}
#endif
