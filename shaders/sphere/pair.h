// Pairs of bodies: how near is near. Needs the bindings Settings, Bodies, States, Shapes.

float time_step;  // s, of this step

// Way the surface of a body may move in one step, and the distance at which contacts are kept.
float reach(SphereWorld world, uint body, float radius, float diagonal) {
  float base = 0.5 * settings.margin * diagonal;
  if (!moves(body)) return base;
  return base + (length(states[body].velocity.xyz) + length(states[body].spin.xyz) * radius +
                 length(world.gravity.xyz) * time_step) * time_step;
}

// Way that the bodies of a pair may make towards each other in one step (m).
float way_of(SphereWorld world, SpherePair pair) {
  bool ground = pair.b == SPHERE_GROUND;
  SphereState a = states[pair.a];
  vec3 v = ground ? -a.velocity.xyz : states[pair.b].velocity.xyz - a.velocity.xyz;
  float spin = length(a.spin.xyz) * shapes[bodies[pair.a].ids.x].box_center.w;
  if (!ground) spin += length(states[pair.b].spin.xyz) * shapes[bodies[pair.b].ids.x].box_center.w;
  return (length(v) + spin + length(world.gravity.xyz) * time_step) * time_step;
}

// Pose of b in the frame of a; on the ground: of a in the bin's.
void relative_pose(SpherePair pair, out vec3 position, out vec4 orientation) {
  position = states[pair.a].position.xyz;
  orientation = states[pair.a].orientation;
  if (pair.b == SPHERE_GROUND) return;
  position = (states[pair.b].position.xyz - position) * rotation_of(orientation);
  orientation = quat_multiply(quat_conjugate(orientation), states[pair.b].orientation);
}

float size_of(SpherePair pair) {
  float size = shapes[bodies[pair.a].ids.x].box_half.w;
  return pair.b == SPHERE_GROUND ? size : min(size, shapes[bodies[pair.b].ids.x].box_half.w);
}

#include "sphere/ball.h"

// Whether the pair has hardly moved since its contacts were found, on fine samples or on coarse ones. The point where a
// ball touches stays below it, while one that is kept turns with it and drives it on.
bool recyclable(SphereManifold manifold, SpherePair pair, bool fine) {
  if (manifold.state.z == 0u || is_ball(pair.a) || is_ball(pair.b)) return false;
  float size = size_of(pair), limit = (fine ? settings.recycle : settings.coarse_recycle) * size;
  vec3 position;
  vec4 orientation;
  relative_pose(pair, position, orientation);
  vec3 moved = position - manifold.found_position;
  if (dot(moved, moved) > limit * limit) return false;
  vec4 turn = quat_multiply(quat_conjugate(manifold.found_orientation), orientation);
  return length(turn.xyz) * size < limit;
}
