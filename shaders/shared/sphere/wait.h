// Which contacts wait in relaxation: they take no impulse in the sweeps after bodies have moved. A part that rolls has
// contacts that press, and others that it rolls onto next, which are still apart. Relaxation would stop the part there,
// and the next sub-step would stop it again, so that the part would lose the energy of two corners at each one. What is
// held from several sides does not roll, and in an impact of two bodies all contacts share the impulse at once.
#ifndef SHARED_SPHERE_WAIT_H
#define SHARED_SPHERE_WAIT_H

// Returns whether a contact waits. gap: m; impulse: its normal impulse (N s); force, push: sums over all contacts of the
// manifold, of their normal impulses and of these impulses times their normals (N s).
INLINE Mask waits(Real gap, Real impulse, IN(Real3) normal, Real force, IN(Real3) push) {
  return (gap > 0.0f) AND(impulse <= 0.0f) AND(dot(normal, push) > 0.9f * force);
}
#endif
