// Values that are constant during a sub-step of the solve: the compliance of contacts, the shares of friction and of
// remembered forces that apply, and the tolerance of convergence. Needs the bindings Settings and Progress.
#include "shared/language.h"
#include "shared/sphere/contact.h"
#include "sphere/plan.h"

SphereWorld world;
StepPlan plan;
Give softly_now, firmly_now;  // how compliant contacts are before and after bodies move
float friction_share;                   // share of friction that holds
float kept;                   // share of the last step's forces that this one begins with
bool first_sub_step;          // of the step
float tolerance;              // m/s: a contact whose speed a sweep changes by more is not solved yet

// What holds for sub-step k of world w.
void take_sub_step_of(uint w, uint k) {
  float size = world.gravity.w;
  vec4 softness = settings.softness[progress[w].stiffness];  // rate (of sub-steps), damping ratio, slop (d), refinement
  plan = plan_of(w);
  softly_now = softly(plan.sub_step, softness.x, softness.y, softness.z * size, settings.push_speed / softness.w * size);
  firmly_now = firmly(plan.sub_step);
  first_sub_step = k == 0u;
  friction_share = int(k) < plan.slip_sub_steps ? 0.0 : progress[w].friction_share;
  kept = progress[w].forgets != 0u ? 0.0 : 1.0;
}
