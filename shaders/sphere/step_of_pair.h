// Values of a step that all passes over pairs use: world, plan, margin, samples and poses. Needs the bindings Settings,
// Worlds, Progress, Bodies, States, Shapes.
#include "sphere/body.h"
#include "sphere/pair.h"
#include "sphere/placement.h"
#include "sphere/plan.h"

StepPlan plan;
uint world_index;

void take_world_of(SpherePair pair) {
  world_index = bodies[pair.a].ids.y;
  time_step = progress[world_index].time_step;
  plan = plan_of(world_index);
}

// Returns the distance (m) up to which candidates of a pair are found.
float margin_of(SpherePair pair) { return settings.margin * size_of(pair) + travel_of(worlds[world_index], pair); }

SphereSamples samples_of(uint body) {
  uint shape = bodies[body].ids.x;
  if (progress[world_index].fine != 0u) return shapes[shape].fine;
  return shapes[shape].coarse;
}

// Returns the pose of a body of this world at the contact time.
Placement placement_of(uint body) { return placement_of(body, plan.contact_time); }
