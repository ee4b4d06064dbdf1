// The plan of a step: how many sub-steps, sweeps and relaxation sweeps are done. The CPU form and the GPU form of the
// solver both use it.
#ifndef SHARED_SPHERE_PLAN_H
#define SHARED_SPHERE_PLAN_H
struct StepPlan {
  int sub_steps, sweeps;  // of each: sweeps before bodies move
  int relaxing_sweeps;    // after. Rigid contacts push slowly, so that one takes back what is left of it; with none
                          // a gear on its teeth rolls forever
  int slip_sub_steps;     // the first ones, without friction: while the forces of a probe are found
  float sub_step;         // s
  float half_way;         // s from the step's start to the mean of its sub-steps' beginnings. Contacts, levers and
                          // normals are of then, which makes the motion the symplectic Euler method over the
                          // sub-steps and keeps energy; with those of the start, what rolls on an edge gains some
};

// time_step: s; sweeps: of a sub-step, before and after; probe_slip: s; forgets: the step begins without forces.
INLINE StepPlan plan_step(float time_step, int sub_steps, int sweeps, bool rigid, bool forgets, float probe_slip) {
  StepPlan plan;
  plan.sub_steps = sub_steps;
  plan.sub_step = time_step / float(sub_steps);
  plan.sweeps = sweeps;
  plan.relaxing_sweeps = rigid ? 1 : sweeps;
  plan.slip_sub_steps = 0;
  if (forgets && rigid && probe_slip > 0.0f) plan.slip_sub_steps = max(1, int(probe_slip / plan.sub_step + 0.5f));
  plan.half_way = 0.5f * (time_step - plan.sub_step);
  return plan;
}
#endif
