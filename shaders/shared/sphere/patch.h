// Friction patches. Contacts of a manifold that press within a small area are treated as a disk of contact, which also
// resists rotation of one body relative to the other. A disk with even pressure resists spin about its normal with a
// torque of 2/3 of its radius times the friction force (Contensou, "Couplage entre frottement de glissement et
// frottement de pivotement", 1963). It tips over its rim at a torque of its radius times the normal force, which is the
// torque of rolling friction. Contacts that are farther apart resist rotation by themselves. Patches are evaluated once
// per sub-step, when the forces of all contacts have been applied; before that, bodies rotate as in free flight.
//
// Use: gather() for all contacts, close_patch(), spread() for all contacts, then both torques.
struct Patch {
  Real impulse;            // sum of the normal impulses of all contacts (N s)
  Real3 center, normal;    // centre of the disk, from the centre of mass of a (m); unit normal of the disk
  Real spin, tipping;      // rad/s, rotation of a relative to b about the normal, and perpendicular to it
  Real3 tip_axis, across;  // unit axis of tipping, and unit direction in the disk perpendicular to it
  Real wide, wide_across;  // sums of normal impulse x squared distance of a contact (m2 N s): from the centre, and from
                           // the axis of tipping
};

INLINE Patch open_patch(IN(Real3) zero) {
  Patch area;
  area.impulse = area.wide = area.wide_across = area.spin = area.tipping = all_lanes(0.0f);
  area.center = area.normal = area.tip_axis = area.across = zero;
  return area;
}

INLINE void gather(INOUT(Patch) area, Real impulse, IN(Real3) ra, IN(Real3) normal) {
  area.impulse += impulse;
  area.center = area.center + impulse * ra;
  area.normal = area.normal + impulse * normal;
}

INLINE void close_patch(INOUT(Patch) area, IN(Real3) turn) {
  area.center = select(area.impulse > 0.0f, 1.0f / area.impulse, all_lanes(0.0f)) * area.center;
  area.normal = unit(area.normal);
  area.spin = dot(area.normal, turn);
  Real3 tipping = turn - area.spin * area.normal;
  area.tip_axis = unit(tipping);
  area.tipping = dot(area.tip_axis, tipping);
  area.across = cross(area.normal, area.tip_axis);
}

INLINE void spread(INOUT(Patch) area, Real impulse, IN(Real3) ra) {
  Real3 off = ra - area.center;
  Real side = dot(area.across, off);
  area.wide += impulse * dot(off, off);
  area.wide_across += impulse * side * side;
}

// Return the largest torque impulses (N m s) against spin and tipping of a patch (radius, m; arm: torque / force, m).
INLINE Real most_against_spin(IN(Patch) area, Real radius, Real friction) {
  Real widest = 4.0f * radius * radius * area.impulse;
  return select(area.wide <= widest, 2.0f / 3.0f * radius * friction * area.impulse, all_lanes(0.0f));
}
INLINE Real most_against_tipping(IN(Patch) area, Real radius, Real arm) {
  Real widest = 4.0f * radius * radius * area.impulse;
  return select(area.wide_across <= widest, arm * area.impulse, all_lanes(0.0f));
}

// Returns the torque impulse (N m s) that stops a rotation of `speed` (rad/s) about an axis, at most `most` (N m s).
// turn_a, turn_b: changes of the angular velocities of a and b by a unit torque impulse about the axis.
INLINE Real moment_against(Real speed, Real most, IN(Real3) axis, IN(Real3) turn_a, IN(Real3) turn_b) {
  Real k = dot(axis, turn_a) + dot(axis, turn_b);
  return min(max(select(k > 0.0f, speed / k, all_lanes(0.0f)), -most), most);
}
