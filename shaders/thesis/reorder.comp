// Per sphere: its place inside the cell by sphere id (so that the order does not depend on arrival), and a copy of
// what the search reads, in cell order.
#include "shared/thesis.h"
#include "shared/dispatch.h"

layout(local_size_x = THESIS_GROUP) in;

layout(std430, binding = BIND_SETTINGS) readonly buffer Settings { ThesisSettingsBlock settings; };
layout(std430, binding = BIND_SPHERES) readonly buffer Spheres { ThesisSphere spheres[]; };
layout(std430, binding = BIND_CENTERS) readonly buffer Centers { vec4 centers[]; };
layout(std430, binding = BIND_SPHERE_CELLS) readonly buffer SphereCells { uint sphere_cells[]; };
layout(std430, binding = BIND_CELL_STARTS) readonly buffer CellStarts { uint cell_starts[]; };
layout(std430, binding = BIND_MEMBERS) readonly buffer Members { uint members[]; };
layout(std430, binding = BIND_SORTED) writeonly buffer Sorted { ThesisSorted sorted[]; };

void main() {
  uint s = thread_index();
  if (s >= settings.spheres) return;
  uint begin = cell_starts[sphere_cells[s]], end = cell_starts[sphere_cells[s] + 1u];
  uint rank = 0u;
  for (uint i = begin; i < end; ++i) rank += members[i] < s ? 1u : 0u;
  sorted[begin + rank] = ThesisSorted(centers[s], uvec4(s, spheres[s].body, 0u, 0u));
}
