// What holds for a sub-step of the solve. Needs the bindings Settings and Progress.

// Soft contact (Catto 2024, "Solver2D"): implicit spring over a sub-step.
struct Spring {
  float bias_rate, mass_scale, impulse_scale;
};

SphereWorld world;
vec4 softness;    // of contacts: rate (Hz), damping ratio, slop (d), sub-steps in place of one
Spring spring;
uint sub_steps;   // of this step: more than by the softness in high heaps
float grip;       // share of friction that holds
float kept;       // share of the last step's forces that this one begins with
float time_step;  // s, of this step

float sub_step() { return time_step / float(sub_steps); }

Spring spring_of(vec4 softness, float h) {
  float omega = 6.2831853 * softness.x / h, a1 = 2.0 * softness.y + h * omega, a2 = h * omega * a1, a3 = 1.0 / (1.0 + a2);
  return Spring(omega / a1, a2 * a3, a3);
}

// What holds for sub-step k of world w.
void take_sub_step_of(uint w, uint k) {
  bool forgets = progress[w].forgets != 0u;
  time_step = progress[w].time_step;
  softness = settings.softness[progress[w].stiffness];
  sub_steps = settings.sub_steps * progress[w].refinement;
  spring = spring_of(softness, sub_step());
  bool slip = forgets && progress[w].stiffness == SPHERE_RIGID;
  uint slips = slip ? max(1u, uint(settings.probe_slip / sub_step() + 0.5)) : 0u;
  grip = k < slips ? 0.0 : progress[w].grip;
  kept = forgets ? 0.0 : 1.0;
}
