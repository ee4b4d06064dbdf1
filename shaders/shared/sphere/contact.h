// One contact in the solve (sequential impulses, Catto 2005, "Iterative dynamics with temporal coherence"; soft
// contacts, Catto 2024, "Solver2D"). Impulses are those of one sub-step (N s). Speeds are those of b relative to a
// along the normal (m/s), positive if the bodies separate. Gaps are in m, negative where the bodies overlap. In C++,
// Real is a vector of eight contacts (lanes.hpp).
#ifndef SHARED_SPHERE_CONTACT_H
#define SHARED_SPHERE_CONTACT_H

// How compliant contacts are in a sweep.
struct Give {
  float sub_step;                         // s
  float rate, mass_share, impulse_share;  // of an implicit spring over a sub-step
  float slop, push_speed;                 // m that overlap may last; m/s at most that let it out
};

// The sweeps before bodies move push overlap out softly. rate: of the spring, / that of sub-steps.
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

// Those after take back the velocity which that has left (relaxation).
INLINE Give firmly(float sub_step) {
  Give give;
  give.sub_step = sub_step;
  give.rate = give.impulse_share = give.slop = give.push_speed = 0.0f;
  give.mass_share = 1.0f;
  return give;
}

// Mass that an impulse meets: moments are arm x direction, turns the spin that they give.
INLINE Real effective_mass(Real inverse_masses, IN(Real3) moment_a, IN(Real3) turn_a, IN(Real3) moment_b,
                           IN(Real3) turn_b) {
  Real k = inverse_masses + dot(moment_a, turn_a) + dot(moment_b, turn_b);
  return select(k > 0.0f, 1.0f / k, all_lanes(0.0f));
}

// Speed along the normal when the gap of a contact has closed, of what closes at `speed` (below 0) when the step
// begins: gravity works on what moves, and an impact returns neither more nor less than what has come down.
INLINE Real speed_at_impact(Real speed, Real gap, Real acceleration) {
  Real square = speed * speed - 2.0f * acceleration * max(gap, all_lanes(0.0f));
  return select(speed < 0.0f, -sqrt(max(square, all_lanes(0.0f))), speed);
}

// A contact that is apart may close the gap, no more.
INLINE Real normal_impulse(Real before, Real speed, Real gap, Real mass, IN(Give) give) {
  Mask apart = gap > 0.0f;
  Real push = max(give.rate * min(gap + give.slop, all_lanes(0.0f)), all_lanes(-give.push_speed));
  Real wanted = speed + select(apart, gap / give.sub_step, push);
  Real mass_share = select(apart, all_lanes(1.0f), all_lanes(give.mass_share));
  Real impulse_share = select(apart, all_lanes(0.0f), all_lanes(give.impulse_share));
  Real change = -mass * mass_share * wanted - impulse_share * before;
  return max(before + change, all_lanes(0.0f));
}

// Whether a sweep that has changed an impulse so was not the last that it takes. tolerance: m/s.
INLINE Mask is_unconverged(Real change, Real mass, float tolerance) {
  return max(change, -change) > tolerance * mass;
}

// Coulomb's cone: both directions at once. most: friction times the normal impulse.
INLINE void put_into_cone(Real most, INOUT(Real) f1, INOUT(Real) f2) {
  Real size = sqrt(f1 * f1 + f2 * f2);
  Real share = select(size > most, most / size, all_lanes(1.0f));
  f1 *= share;
  f2 *= share;
}

// Whether a contact presses and has all the friction that its force allows.
INLINE Mask slips(Real most, Real f1, Real f2) {
  return (most > 0.0f) AND(f1 * f1 + f2 * f2 > 0.999f * most * most);
}

// An impact is distinguished from a force: a force may grow by half in a sub-step, and by what stops impact_speed().
// Beyond, the impulse was that of an impact: it is over, and the next sub-step does not begin with it. A few sweeps do
// not take it back from a heap, which would be thrown up.
const float FORCE_GROWTH = 1.5f;  // more = heaps rebound, less = loads of a deep heap are found later

// Speed (m/s) that a force may take from its bodies in the first sub-step of its life. `weight`: m/s2.
INLINE float impact_speed(float sub_step, float weight, float restitution_speed) {
  float falls = 4.0f * sub_step * weight;
  return falls > 0.0f ? min(falls, restitution_speed) : restitution_speed;
}

// Share of an impulse that the next sub-step begins with, of one that began at `lasting`.
INLINE Real lasting_share(Real impulse, Real lasting, Real mass, float impact_speed) {
  Real most = FORCE_GROWTH * lasting + impact_speed * mass;
  return select(impulse > most, most / impulse, all_lanes(1.0f));
}

// Whether a contact was hit fast enough to bounce: pressed, or closed by an impact that its neighbours took.
INLINE Mask was_hit(Real approach, Mask pressed, Real gap, float sub_step, float restitution_speed) {
  return (approach <= -restitution_speed) AND(pressed OR(gap < -approach * sub_step));
}

// Newton's restitution: towards a separating speed of e times that of the approach.
INLINE Real bounced_impulse(Real before, Real speed, Real mass, Real restitution, Real approach) {
  return max(before - mass * (speed + restitution * approach), all_lanes(0.0f));
}

// Mean speed of a sub-step / speed at its end, of a body that friction brakes all the while: 1 of what is hit, or as
// slow as it is braked in a sub-step.
INLINE float mean_share(float before, float after) {
  return after > 0.5f * before && after < 2.0f * before ? 0.5f * (before / after + 1.0f) : 1.0f;
}
#endif
