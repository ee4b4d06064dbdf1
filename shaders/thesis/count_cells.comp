// Per sphere: its cell, floor((p - origin) / d) clamped to the domain (eqs 5.1, 5.2), and how many share it.
#include "shared/thesis.h"
#include "shared/dispatch.h"

layout(local_size_x = THESIS_GROUP) in;

layout(std430, binding = BIND_SETTINGS) readonly buffer Settings { ThesisSettingsBlock settings; };
layout(std430, binding = BIND_WORLDS) readonly buffer Worlds { ThesisWorld worlds[]; };
layout(std430, binding = BIND_BODIES) readonly buffer Bodies { ThesisBody bodies[]; };
layout(std430, binding = BIND_SPHERES) readonly buffer Spheres { ThesisSphere spheres[]; };
layout(std430, binding = BIND_CENTERS) readonly buffer Centers { vec4 centers[]; };
layout(std430, binding = BIND_SPHERE_CELLS) writeonly buffer SphereCells { uint sphere_cells[]; };
layout(std430, binding = BIND_CELL_COUNTS) buffer CellCounts { uint cell_counts[]; };

#include "thesis/cell.h"

void main() {
  uint s = thread_index();
  if (s >= settings.spheres) return;
  uint world = bodies[spheres[s].body].range.z;
  uint cell = cell_index(worlds[world], cell_of(worlds[world], centers[s].xyz));
  sphere_cells[s] = cell;
  atomicAdd(cell_counts[cell], 1u);
}
