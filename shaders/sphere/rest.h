// Determines whether a body of world `w` is at rest, which means that its pose has changed by less than a limit during
// the rest window, and puts bodies to sleep or wakes them. Needs the bindings Settings, Progress, Bodies, States,
// Shapes and sphere/body.h.

bool moved_recently(uint body) { return moves(body) && states[body].still_position.w < settings.rest_window; }

// Returns whether a body left its pose of rest in this step. Bodies that were only woken by touch have not.
bool went_on(uint body) { return moves(body) && states[body].still_position.w == 0.0; }

void note_motion(uint body, uint w) {
  SphereState s = states[body];
  uint shape = bodies[body].ids.x;
  float within = progress[w].sleep == SPHERE_SLEEP_BY_TOUCH ? settings.touch_move : settings.rest_move;
  float limit = within * shapes[shape].box_half.w;
  vec3 moved = s.position.xyz - s.still_position.xyz;
  float turned = 2.0 * length(quat_multiply(quat_conjugate(s.still_orientation), s.orientation).xyz);
  if (length(moved) > limit || turned * shapes[shape].box_center.w > limit) {
    states[body].still_position = vec4(s.position.xyz, 0.0);
    states[body].still_orientation = s.orientation;
  } else {
    states[body].still_position.w += progress[w].time_step;
  }
}

// Puts a body to sleep or wakes it (stays_awake), and stores the label of its island. In mode by_part, a woken body can
// sleep again at once if it does not move; in mode by_touch, after the rest window.
void settle(uint body, uint label, bool stays_awake, uint w) {
  uint flags = states[body].flags.x;
  states[body].flags.y = label + 1u;
  if ((flags & SPHERE_PRESENT) == 0u || bodies[body].material.x == 0.0) return;
  bool asleep = (flags & SPHERE_ASLEEP) != 0u;
  if (!stays_awake && !asleep) {
    states[body].velocity = vec4(0.0);
    states[body].spin = vec4(0.0);
  }
  if (stays_awake && asleep && progress[w].sleep != SPHERE_SLEEP_BY_PART)
    states[body].still_position.w = progress[w].sleep == SPHERE_SLEEP_BY_TOUCH ? progress[w].time_step : 0.0;
  states[body].flags.x = stays_awake ? flags & ~SPHERE_ASLEEP : flags | SPHERE_ASLEEP;
}
