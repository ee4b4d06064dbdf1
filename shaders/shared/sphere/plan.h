// The plan of a step: how many sub-steps, sweeps and relaxation sweeps are done. The CPU form and the GPU form of the
// solver both use it.
#ifndef SHARED_SPHERE_PLAN_H
#define SHARED_SPHERE_PLAN_H
struct StepPlan {
  int sub_steps, sweeps;  // sweeps: in each sub-step, before bodies move
  int relaxing_sweeps;    // sweeps after bodies have moved. Rigid contacts push slowly, so that one sweep removes the
                          // velocity that is left; without it, a gear on its teeth rolls forever
  int slip_sub_steps;     // the first sub-steps, which have no friction while the forces of a probe are found
  float sub_step;         // s
  float contact_time;     // s from the start of the step to the mean of the times at which its sub-steps begin.
                          // Contacts, lever arms and normals belong to that time, which makes the motion the symplectic
                          // Euler method over the sub-steps and conserves energy; with those of the start of the step,
                          // bodies that roll on an edge gain energy
};

// Plans a step. time_step: s; sweeps: of a sub-step, before and after bodies move; probe_slip: s; forgets: whether the
// step starts without forces.
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
