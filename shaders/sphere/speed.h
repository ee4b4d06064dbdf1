// The speed of a body: the highest speed of any point of its surface (m/s), and its speed of rotation (rad/s). Needs
// sphere/body.h and the binding Shapes.

// Returns an upper bound of the speed (m/s) of any point of a body (x), and its angular speed (rad/s, y).
vec2 speeds_of(uint body) {
  float turn = length(states[body].spin.xyz);
  return vec2(length(states[body].velocity.xyz) + turn * shapes[bodies[body].ids.x].box_center.w, turn);
}

// Returns the number of shortened steps for the highest speeds of a world; thinnest: m. Needs the binding Settings.
uint cuts_of(vec2 speeds, float thinnest) {
  if (settings.cut_steps == 0u) return 1u;
  return cuts_of(speeds.x * settings.time_step, speeds.y * settings.time_step, thinnest);
}
