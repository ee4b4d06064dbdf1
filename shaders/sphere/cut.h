// Steps are cut for as long as something is fast: parts would fly through each other, and contacts would pull at levers
// that have long turned away. Twin: cuts_of_fast(). Needs the bindings Settings, States and Shapes, and sphere/body.h.
const float LONGEST_WAY = 1.0;    // of the fastest part in one step: thicknesses of the thinnest part
const float LONGEST_TURN = 0.4;   // rad; beyond, also
const float TURN_OF_A_CUT = 0.1;  // rad: keeps a tumbling part's energy and angular momentum
const float MOST_CUTS = 64.0;

// Highest speed (m/s) of the surface of a body, and how fast it turns (rad/s).
vec2 speeds_of(uint body) {
  float turn = length(states[body].spin.xyz);
  return vec2(length(states[body].velocity.xyz) + turn * shapes[bodies[body].ids.x].box_center.w, turn);
}

// Cuts of a step in which nothing is faster than these.
uint cuts_of(vec2 speeds, float thinnest) {
  if (settings.cut_steps == 0u) return 1u;
  vec2 way = speeds * settings.time_step;
  float cuts = max(1.0, way.x / (LONGEST_WAY * thinnest));
  if (way.y > LONGEST_TURN) cuts = max(cuts, way.y / TURN_OF_A_CUT);
  return uint(ceil(min(cuts, MOST_CUTS)));
}
