// What two bodies of a manifold have in common. Needs the binding Bodies and `world`.
float friction_between(SphereOrdered m) {
  return sqrt(bodies[m.a].material.y * (m.b == SPHERE_GROUND ? world.ground.x : bodies[m.b].material.y));
}
float restitution_of(SphereOrdered m) {
  return max(bodies[m.a].material.z, m.b == SPHERE_GROUND ? world.ground.y : bodies[m.b].material.z);
}
