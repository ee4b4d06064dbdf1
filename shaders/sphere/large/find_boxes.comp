// Boxes of the bodies of a large world, and the largest of those that move. Twin: bounds in find_pairs().
#include "shared/sphere_large.h"
#include "shared/dispatch.h"

layout(local_size_x = SPHERE_GROUP) in;

layout(std430, binding = BIND_SETTINGS) readonly buffer Settings { SphereSettingsBlock settings; };
layout(std430, binding = BIND_WORLDS) readonly buffer Worlds { SphereWorld worlds[]; };
layout(std430, binding = BIND_PROGRESS) buffer Progress { SphereProgress progress[]; };
layout(std430, binding = BIND_PLANES) readonly buffer Planes { SpherePlane planes[]; };
layout(std430, binding = BIND_BODIES) readonly buffer Bodies { SphereBody bodies[]; };
layout(std430, binding = BIND_STATES) readonly buffer States { SphereState states[]; };
layout(std430, binding = BIND_TENSORS) writeonly buffer Tensors { SphereTensor tensors[]; };
layout(std430, binding = BIND_SHAPES) readonly buffer Shapes { SphereShape shapes[]; };
layout(std430, binding = BIND_LARGE) buffer Large { SphereLarge large; };
layout(std430, binding = BIND_BOXES) writeonly buffer Boxes { SphereBox boxes[]; };
layout(std430, binding = BIND_WORK) buffer Work { SphereWork work[]; };

#include "sphere/body.h"
#include "sphere/pair.h"
#include "sphere/oriented_box.h"
#include "sphere/box.h"
#include "sphere/large/large_world.h"

void main() {
  uint i = thread_index();
  SphereWorld world = worlds[large_world];
  if (idle() || i >= world.bodies.y) return;
  time_step = progress[large_world].time_step;
  uint body = world.bodies.x + i;
  Box box = box_of(world, body);
  boxes[i] = SphereBox(box.center, box.half_size, ivec4(0));
  if (present(body)) tensors[body] = tensor_of(body);
  work[i] = SphereWork(uint[2](0xffffffffu, 0xffffffffu), 0u, 0u);
  if (box.half_size.w == 0.0) return;
  float extent = 2.0 * max(box.half_size.x, max(box.half_size.y, box.half_size.z));
  atomicMax(large.extent, floatBitsToUint(extent));
}
