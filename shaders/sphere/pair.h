// Geometry of pairs: the distance that the surface of a body may move in one step, within which contacts are searched
// ahead; the relative pose of two bodies; and the size of the smaller one. Needs the bindings Settings, Bodies, States,
// Shapes.

float time_step;  // length of this step (s)

// Returns the margin (m) of a body's box: half of the contact margin + the movement of its surface in a step.
float reach(SphereWorld world, uint body, float radius, float diagonal) {
  float base = 0.5 * settings.margin * diagonal;
  if (!moves(body)) return base;
  return base + (length(states[body].velocity.xyz) + length(states[body].spin.xyz) * radius +
                 length(world.gravity.xyz) * time_step) * time_step;
}

// Returns the distance (m) by which the bodies of a pair may approach each other in one step.
float travel_of(SphereWorld world, SpherePair pair) {
  bool ground = pair.b == SPHERE_GROUND;
  SphereState a = states[pair.a];
  vec3 v = ground ? -a.velocity.xyz : states[pair.b].velocity.xyz - a.velocity.xyz;
  float spin = length(a.spin.xyz) * shapes[bodies[pair.a].ids.x].box_center.w;
  if (!ground) spin += length(states[pair.b].spin.xyz) * shapes[bodies[pair.b].ids.x].box_center.w;
  return (length(v) + spin + length(world.gravity.xyz) * time_step) * time_step;
}

// Computes the pose of b in the frame of a; if b is the ground, the pose of a in the frame of the bin.
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

