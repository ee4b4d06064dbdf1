// Sorts the bodies of a large world by cell: counted first, put in place when the counts are summed up. Which of a
// cell's bodies comes first never matters. Bodies larger than a cell go to the end of the list, by themselves.
#include "shared/sphere_large.h"
#include "shared/dispatch.h"

layout(local_size_x = SPHERE_GROUP) in;

layout(std430, binding = BIND_WORLDS) readonly buffer Worlds { SphereWorld worlds[]; };
layout(std430, binding = BIND_PROGRESS) buffer Progress { SphereProgress progress[]; };
layout(std430, binding = BIND_LARGE) buffer Large { SphereLarge large; };
layout(std430, binding = BIND_BOXES) buffer Boxes { SphereBox boxes[]; };
layout(std430, binding = BIND_CELL_COUNTS) buffer CellCounts { uint cell_counts[]; };
layout(std430, binding = BIND_CELL_STARTS) readonly buffer CellStarts { uint cell_starts[]; };
layout(std430, binding = BIND_SORTED) writeonly buffer Sorted { uint sorted[]; };

#include "sphere/large/large_world.h"
#include "sphere/large/cell.h"

uniform uint stage;  // LIST_COUNT, LIST_PLACE

void main() {
  uint i = thread_index();
  if (idle()) return;
  SphereWorld world = worlds[large_world];
  if (i >= world.bodies.y) return;
  SphereBox box = boxes[i];
  if (box.half_size.x < 0.0) return;  // absent
  if (stage == LIST_COUNT) boxes[i].cell = box.cell = cell_of(box);
  if (box.cell.w == 0) {
    if (stage == LIST_PLACE) sorted[world.bodies.y - 1u - atomicAdd(large.big, 1u)] = i;
    return;
  }
  uint bucket = bucket_of(box.cell.xyz);
  if (stage == LIST_COUNT)
    atomicAdd(cell_counts[bucket], 1u);
  else
    sorted[cell_starts[bucket] + atomicAdd(cell_counts[bucket], 0xffffffffu) - 1u] = i;  // leaves the counts at 0
}
