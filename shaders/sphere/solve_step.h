// Values that are constant during a sub-step of the solve: the compliance of contacts, the shares of friction and of
// remembered forces that apply, and the tolerance of convergence. Needs the bindings Settings and Progress.
#include "shared/language.h"
#include "shared/sphere/contact.h"
#include "sphere/plan.h"

SphereWorld world;
StepPlan plan;
Give softly_now, firmly_now;  // compliance of contacts in the sweeps before and after bodies move
float friction_share;                   // factor of all coefficients of friction in this sub-step
float kept;                   // share of the contact forces of the last step with which this step begins: 0 or 1
bool first_sub_step;          // whether this is the first sub-step of the step
float tolerance;              // m/s: a contact whose speed a sweep changes by more is not solved yet

// Sets the values above for sub-step k of world w, except the tolerance.
void take_sub_step_of(uint w, uint k) {
  float size = world.gravity.w;
  vec4 softness = settings.softness[progress[w].stiffness];  // frequency, damping ratio, slop, refinement
  plan = plan_of(w);
  softly_now = softly(plan.sub_step, softness.x, softness.y, softness.z * size, settings.push_speed / softness.w * size);
  firmly_now = firmly(plan.sub_step);
  first_sub_step = k == 0u;
  friction_share = int(k) < plan.slip_sub_steps ? 0.0 : progress[w].friction_share;
  kept = progress[w].forgets != 0u ? 0.0 : 1.0;
}
