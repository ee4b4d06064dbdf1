// The speed of a body: the highest speed of any point of its surface (m/s), and its speed of rotation (rad/s). Needs
// sphere/body.h and the binding Shapes.

// Highest speed (m/s) of the surface of a body, and its angular speed (rad/s).
vec2 speeds_of(uint body) {
  float turn = length(states[body].spin.xyz);
  return vec2(length(states[body].velocity.xyz) + turn * shapes[bodies[body].ids.x].box_center.w, turn);
}

// Cuts of a step in which nothing is faster than these. Needs the binding Settings.
uint cuts_of(vec2 speeds, float thinnest) {
  if (settings.cut_steps == 0u) return 1u;
  return cuts_of(speeds.x * settings.time_step, speeds.y * settings.time_step, thinnest);
}
