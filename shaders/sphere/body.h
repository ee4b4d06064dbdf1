// Functions that read a body as the passes need it: pose, velocity, mass and whether it moves. Needs the bindings
// Bodies and States.
#include "shared/rotation.h"

bool present(uint body) { return (states[body].flags.x & SPHERE_PRESENT) != 0u; }

bool moves(uint body) {
  return (states[body].flags.x & (SPHERE_PRESENT | SPHERE_ASLEEP)) == SPHERE_PRESENT && bodies[body].material.x > 0.0;
}

bool sleeps(uint body) {
  return (states[body].flags.x & (SPHERE_PRESENT | SPHERE_ASLEEP)) == (SPHERE_PRESENT | SPHERE_ASLEEP);
}

// Returns whether a body is present but is not moved in this step, because it is fixed or asleep.
bool waits(uint body) { return present(body) && !moves(body); }

mat3 rotation_of(vec4 q) {
  vec3 t = 2.0 * q.xyz, w = t * q.w, x = t * q.x;
  float yy = t.y * q.y, yz = t.z * q.y, zz = t.z * q.z;
  return mat3(1.0 - (yy + zz), x.y + w.z, x.z - w.y,
              x.y - w.z, 1.0 - (x.x + zz), yz + w.x,
              x.z + w.y, yz - w.x, 1.0 - (x.x + yy));
}

mat3 symmetric(vec4 diagonal, vec4 mixed) {
  return mat3(diagonal.x, mixed.x, mixed.y, mixed.x, diagonal.y, mixed.z, mixed.y, mixed.z, diagonal.z);
}

mat3 magnitudes(mat3 m) { return mat3(abs(m[0]), abs(m[1]), abs(m[2])); }
