// Per sphere: into its cell's stretch of the list, in order of arrival; reorder puts that right.
#include "shared/thesis.h"
#include "shared/dispatch.h"

layout(local_size_x = THESIS_GROUP) in;

layout(std430, binding = BIND_SETTINGS) readonly buffer Settings { ThesisSettingsBlock settings; };
layout(std430, binding = BIND_SPHERE_CELLS) readonly buffer SphereCells { uint sphere_cells[]; };
layout(std430, binding = BIND_CELL_COUNTS) buffer CellCounts { uint cell_counts[]; };
layout(std430, binding = BIND_CELL_STARTS) readonly buffer CellStarts { uint cell_starts[]; };
layout(std430, binding = BIND_MEMBERS) writeonly buffer Members { uint members[]; };

void main() {
  uint s = thread_index();
  if (s >= settings.spheres) return;
  uint cell = sphere_cells[s];
  // Counting down leaves the counts at zero for the next step.
  members[cell_starts[cell] + atomicAdd(cell_counts[cell], 0xffffffffu) - 1u] = s;
}
