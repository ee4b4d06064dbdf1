// The plan of a step: how many sub-steps, sweeps and relaxation sweeps are done. The CPU form and the GPU form of the
// solver both use it.
#ifndef SHARED_SPHERE_PLAN_H
#define SHARED_SPHERE_PLAN_H
struct StepPlan {
  int sub_steps, sweeps;  // number of sub-steps, and number of sweeps in each sub-step before bodies move
  int relaxing_sweeps;    // sweeps in each sub-step after bodies have moved. Rigid contacts push slowly, so that one
                          // sweep removes the remaining velocity; without it, a gear on its teeth rolls forever
  int slip_sub_steps;     // number of the first sub-steps that are without friction while a probe finds its forces
  float sub_step;         // length of a sub-step (s)
  float contact_time;     // s from the start of the step to the mean of the times at which its sub-steps begin.
                          // Contacts, lever arms and normals belong to that time, which makes the motion the symplectic
                          // Euler method over the sub-steps and conserves energy; with those of the start of the step,
                          // bodies that roll on an edge gain energy
};

// Returns the plan of a step. time_step: s; sweeps: number in a sub-step before and after bodies move; rigid: whether
// contacts are rigid; forgets: whether the step starts without remembered forces; probe_slip: s without friction.
INLINE StepPlan plan_step(float time_step, int sub_steps, int sweeps, bool rigid, bool forgets, float probe_slip) {
  StepPlan plan;
  plan.sub_steps = sub_steps;
  plan.sub_step = time_step / float(sub_steps);
  plan.sweeps = sweeps;
  plan.relaxing_sweeps = rigid ? 1 : sweeps;
  plan.slip_sub_steps = 0;
  if (forgets && rigid && probe_slip > 0.0f) plan.slip_sub_steps = max(1, int(probe_slip / plan.sub_step + 0.5f));
  plan.contact_time = 0.5f * (time_step - plan.sub_step);
  return plan;
}
#endif
