// The pairs of a world that may come near in the next steps, in the order of (a, b). Each body has a box that holds its
// upright box for as long as it moves as it does now; bodies whose boxes meet are listed. The list is made anew when an
// upright box leaves the box of its body. Needs the bindings Settings, Bodies, States, Shapes, Near, Boxes,
// sphere/pair.h and sphere/oriented_box.h.

const float LISTED_STEPS = 10.0;  // for which a list is made
const float LISTED_MOVE = 0.01;   // d: of a body that stays where it is
const float ROUNDING = 1e-5;      // of lengths (m), far above that of floats: it must not hide a pair

// An entry of the list: a << 16 | b, counted in the world.
const uint IN_PAIRS = 0x80000000u;  // and in the list of pairs
const uint GROUND_ENTRY = 0xffffu;

uint first_of(uint entry) { return entry >> 16 & 0x7fffu; }
uint second_of(uint entry) { return entry & 0xffffu; }
uint entry_of(SphereWorld world, SpherePair pair) {
  uint b = pair.b == SPHERE_GROUND ? GROUND_ENTRY : pair.b - world.bodies.x;
  return pair.a - world.bodies.x << 16 | b;
}

// Places in Near: the bits of row i, word k; then the list.
uint word_of(SphereWorld world, uint i, uint k) { return world.bodies.w + i * world.bodies.z + k; }
uint list_of_near(SphereWorld world) { return world.bodies.w + world.bodies.y * world.bodies.z; }

// Where the upright box of a body will be, as far as its speed and gravity say; none of an absent one. w of half_size: 0
// = nothing ever moves it.
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
             seconds * time_step * length(world.gravity.xyz);  // the box grows with the speed
  }
  return Box(vec4(mid, 0.0), vec4(now.half_size.xyz + extra, can_move));
}

// What bodies are listed by.
vec3 rounded_up(Box listed) { return listed.half_size.xyz + ROUNDING * (abs(listed.center.xyz) + listed.half_size.xyz + 1.0); }

// Whether an upright box is where the list takes it to be.
bool is_listed(SphereBox listed, Box now) {
  if (now.half_size.x < 0.0) return true;  // absent
  return all(lessThanEqual(abs(now.center.xyz - listed.center) + now.half_size.xyz, listed.half_size));
}
