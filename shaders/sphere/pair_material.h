// Friction and restitution of a manifold, combined from those of its two bodies. Needs the binding Bodies, `world` and
// sphere/ordered.h.
float friction_between(Members m) {
  return sqrt(bodies[m.a].material.y * (m.b == SPHERE_GROUND ? world.ground.x : bodies[m.b].material.y));
}
float restitution_of(Members m) {
  return max(bodies[m.a].material.z, m.b == SPHERE_GROUND ? world.ground.y : bodies[m.b].material.z);
}
