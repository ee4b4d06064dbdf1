// Rows of the contacts that this step solves, an invocation a manifold; SPHERE_PREPARE_GROUPS groups a world. With an
// invocation a contact, each would read what all contacts of its manifold have in common. Twin: prepare().
#include "shared/sphere.h"
#include "shared/dispatch.h"

layout(local_size_x = SPHERE_PREPARE_GROUP) in;

layout(std430, binding = BIND_SETTINGS) readonly buffer Settings { SphereSettingsBlock settings; };
layout(std430, binding = BIND_RUNNING) readonly buffer Running { uint running[]; };
layout(std430, binding = BIND_WORLDS) readonly buffer Worlds { SphereWorld worlds[]; };
layout(std430, binding = BIND_PROGRESS) readonly buffer Progress { SphereProgress progress[]; };
layout(std430, binding = BIND_BODIES) readonly buffer Bodies { SphereBody bodies[]; };
layout(std430, binding = BIND_STATES) readonly buffer States { SphereState states[]; };
layout(std430, binding = BIND_SHAPES) readonly buffer Shapes { SphereShape shapes[]; };
layout(std430, binding = BIND_TENSORS) readonly buffer Tensors { SphereTensor tensors[]; };
layout(std430, binding = BIND_CONTACTS) buffer Contacts { SphereContact contacts[]; };
layout(std430, binding = BIND_ORDER) buffer Order { SphereOrdered order[]; };
layout(std430, binding = BIND_ROWS) buffer Rows { vec4 rows[]; };
layout(std430, binding = BIND_IMPULSES) buffer Impulses { vec2 impulses[]; };

#include "shared/language.h"
#include "sphere/body.h"
#include "sphere/solve_step.h"
#include "sphere/contact_row.h"
#include "sphere/prepare_row.h"

void main() {
  uint w = running[group_index() / SPHERE_PREPARE_GROUPS], part = group_index() % SPHERE_PREPARE_GROUPS;
  world = worlds[w];
  if (progress[w].steps_left == 0u || progress[w].overflow != 0u) return;
  take_sub_step_of(w, 0u);
  for (uint o = part * SPHERE_PREPARE_GROUP + gl_LocalInvocationIndex; o < progress[w].ordered;
       o += SPHERE_PREPARE_GROUPS * SPHERE_PREPARE_GROUP)
    prepare_manifold(o);
}
