// The plan of the present step of world w: numbers of sub-steps and sweeps (shared/sphere/plan.h). Twin: World::plan().
// Needs the bindings Settings and Progress.
#include "shared/language.h"
#include "shared/sphere/plan.h"

StepPlan plan_of(uint w) {
  uint sweeps = progress[w].effort * (progress[w].cold_steps != 0u ? settings.cold_sweeps : settings.sweeps);
  return plan_step(progress[w].time_step, int(settings.sub_steps * progress[w].refinement), int(sweeps),
                   progress[w].stiffness == SPHERE_RIGID, progress[w].forgets != 0u, settings.probe_slip);
}
