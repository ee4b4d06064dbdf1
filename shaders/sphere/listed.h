// List of the pairs of a world that may come near each other in the next steps, in the order of (a, b). Each body has a
// larger box that contains its upright box while its velocity hardly changes; pairs whose larger boxes intersect are
// listed. The list is made again when an upright box leaves the larger box of its body. Needs the bindings Settings,
// Bodies, States, Shapes, Near, Boxes, sphere/pair.h and sphere/oriented_box.h.

const float LISTED_STEPS = 10.0;  // number of steps for which the larger boxes contain the motion of the bodies
const float LISTED_MOVE = 0.01;   // margin of the larger box in sizes of the part, for bodies that do not move
const float ROUNDING = 1e-5;      // relative margin of boxes, larger than rounding errors, so that no pair is missed

// An entry of the list is a << 16 | b, with indices of bodies within the world.
const uint IN_PAIRS = 0x80000000u;  // bit of an entry: the pair is also in the list of pairs
const uint GROUND_ENTRY = 0xffffu;  // value of b for the ground

uint first_of(uint entry) { return entry >> 16 & 0x7fffu; }
uint second_of(uint entry) { return entry & 0xffffu; }
uint entry_of(SphereWorld world, SpherePair pair) {
  uint b = pair.b == SPHERE_GROUND ? GROUND_ENTRY : pair.b - world.bodies.x;
  return pair.a - world.bodies.x << 16 | b;
}

// Return positions in the buffer Near: of word k of the neighbour bits of body i, and of the first entry of the list.
uint word_of(SphereWorld world, uint i, uint k) { return world.bodies.w + i * world.bodies.z + k; }
uint list_of_near(SphereWorld world) { return world.bodies.w + world.bodies.y * world.bodies.z; }

// Returns the larger box of a body, predicted from its speed and gravity; its half size is negative if the body is
// absent. half_size.w: 0 if the body is fixed.
Box listed_box(SphereWorld world, uint body, Box now) {
  vec4 center = shapes[bodies[body].ids.x].box_center, half_size = shapes[bodies[body].ids.x].box_half;
  float can_move = bodies[body].material.x > 0.0 ? 1.0 : 0.0;
  if (!present(body)) return Box(vec4(0.0), vec4(vec3(-1e30), can_move));
  vec3 mid = now.center.xyz, extra = vec3(LISTED_MOVE * half_size.w);
  if (moves(body)) {
    float seconds = LISTED_STEPS * time_step;
    vec3 path = seconds * (states[body].velocity.xyz + 0.5 * seconds * world.gravity.xyz);
    mid += 0.5 * path;
    extra += 0.5 * abs(path) + min(seconds * length(states[body].spin.xyz), 1.0) * center.w +
             seconds * time_step * length(world.gravity.xyz);  // the upright box grows with the speed
  }
  return Box(vec4(mid, 0.0), vec4(now.half_size.xyz + extra, can_move));
}

// Returns the half extents (m) of a larger box with a margin for rounding.
vec3 rounded_up(Box listed) { return listed.half_size.xyz + ROUNDING * (abs(listed.center.xyz) + listed.half_size.xyz + 1.0); }

// Returns whether the present upright box of a body is within its larger box, so that the list is valid for it.
bool is_listed(SphereBox listed, Box now) {
  if (now.half_size.x < 0.0) return true;  // absent
  return all(lessThanEqual(abs(now.center.xyz - listed.center) + now.half_size.xyz, listed.half_size));
}
