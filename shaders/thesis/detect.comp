// Per sphere of a moving body: the contacts with spheres in its own and the 26 neighbouring cells and with the bin's
// sheets. Of more than CAPACITY the deepest are kept, ties by id, so the choice does not depend on the order of search.
// Contacts lie one after another, as many slots as there are contacts: those of a sphere together, in their order, the
// spheres as they come. Where they lie changes nothing: each sphere finds its own by its range.
#include "shared/thesis.h"
#include "shared/rotation.h"
#include "shared/dispatch.h"

layout(local_size_x = THESIS_GROUP) in;

layout(std430, binding = BIND_SETTINGS) readonly buffer Settings { ThesisSettingsBlock settings; };
layout(std430, binding = BIND_WORLDS) readonly buffer Worlds { ThesisWorld worlds[]; };
layout(std430, binding = BIND_SHEETS) readonly buffer Sheets { ThesisSheet sheets[]; };
layout(std430, binding = BIND_BODIES) readonly buffer Bodies { ThesisBody bodies[]; };
layout(std430, binding = BIND_STATES) readonly buffer States { ThesisState states[]; };
layout(std430, binding = BIND_SHAPES) readonly buffer Shapes { ThesisShape shapes[]; };
layout(std430, binding = BIND_SPHERES) readonly buffer Spheres { ThesisSphere spheres[]; };
layout(std430, binding = BIND_CENTERS) readonly buffer Centers { vec4 centers[]; };
layout(std430, binding = BIND_CELL_STARTS) readonly buffer CellStarts { uint cell_starts[]; };
layout(std430, binding = BIND_SORTED) readonly buffer Sorted { ThesisSorted sorted[]; };
layout(std430, binding = BIND_CONTACT_RANGES) writeonly buffer ContactRanges { ThesisRange contact_ranges[]; };
layout(std430, binding = BIND_CONTACTS) writeonly buffer Contacts { ThesisContact contacts[]; };
layout(std430, binding = BIND_TOUCHING_SPHERES) writeonly buffer TouchingSpheres { uint touching_spheres[]; };
layout(std430, binding = BIND_STATUS) buffer Status { ThesisStatus status; };
layout(std430, binding = BIND_NEEDS) buffer Needs { ThesisNeed needs[]; };

#include "thesis/cell.h"
#include "thesis/contact_geometry.h"

uint found = 0u, kept = 0u;
float kept_depth[CAPACITY];
uint kept_other[CAPACITY];

void keep(float depth, uint other) {
  ++found;
  uint at = kept;
  while (at > 0u && (kept_depth[at - 1u] < depth || (kept_depth[at - 1u] == depth && kept_other[at - 1u] > other))) --at;
  if (at == CAPACITY) return;
  kept = min(kept + 1u, CAPACITY);
  for (uint i = kept - 1u; i > at; --i) {
    kept_depth[i] = kept_depth[i - 1u];
    kept_other[i] = kept_other[i - 1u];
  }
  kept_depth[at] = depth;
  kept_other[at] = other;
}

void search_spheres(ThesisWorld world, vec4 center, uint body) {
  uvec3 cell = cell_of(world, center.xyz);
  uvec3 low = max(cell, uvec3(1u)) - 1u, high = min(cell + 1u, world.grid.xyz - 1u);
  for (uint z = low.z; z <= high.z; ++z)
    for (uint y = low.y; y <= high.y; ++y) {
      // The cells of a row lie side by side.
      uint end = cell_starts[cell_index(world, uvec3(high.x, y, z)) + 1u];
      for (uint i = cell_starts[cell_index(world, uvec3(low.x, y, z))]; i < end; ++i) {
        if (sorted[i].owner.y == body) continue;
        vec4 other = sorted[i].center;
        float depth = center.w + other.w - distance(center.xyz, other.xyz);
        if (depth > 0.0) keep(depth, sorted[i].owner.x);
      }
    }
}

void search_sheets(ThesisWorld world, vec4 center) {
  for (uint k = 0u; k < world.sheets.y; ++k) {
    ThesisSheet sheet = sheets[world.sheets.x + k];
    if (!sheet_in_reach(sheet, center)) continue;
    int reach = sheet_deep(sheet, center) ? 0 : int(ceil((center.w + sheet.origin.w) / sheet.normal.w));
    for (int dv = -reach; dv <= reach; ++dv)
      for (int du = -reach; du <= reach; ++du) {
        if (!sheet_has_node(sheet, center, du, dv)) continue;
        float depth = node_depth(sheet, center, du, dv);
        if (depth > 0.0) keep(depth, node_code(k, du, dv));
      }
  }
}

shared uint group_kept, group_touching;              // contacts and touching spheres of the group
shared uint group_first_kept, group_first_touching;  // where theirs begin

void main() {
  if (gl_LocalInvocationIndex == 0u) group_kept = group_touching = 0u;
  uint slot = thread_index(), s = settings.moving_spheres, body = 0u;
  if (slot < settings.spheres) {
    s = sorted[slot].owner.x;
    body = sorted[slot].owner.y;
  }
  ThesisWorld world = worlds[bodies[body].range.z];
  if (s < settings.moving_spheres) {  // static pairs are never looked at
    vec4 center = sorted[slot].center;
    search_spheres(world, center, body);
    search_sheets(world, center);
    contact_ranges[s] = ThesisRange(0u, 0u);
    if (found > 0u) atomicMax(needs[bodies[body].range.z].contacts, found);
    if (found > CAPACITY) atomicOr(status.overflow, THESIS_CONTACT_OVERFLOW);
  }

  // Places: first within the group, then the group's own, so that few invocations wait for the same word.
  barrier();
  uint first = 0u, at = 0u;
  if (kept > 0u) {
    first = atomicAdd(group_kept, kept);
    at = atomicAdd(group_touching, 1u);
  }
  barrier();
  if (gl_LocalInvocationIndex == 0u && group_kept > 0u) {
    group_first_kept = atomicAdd(status.slots, group_kept);
    group_first_touching = atomicAdd(status.touching_spheres, group_touching);
    if (group_first_kept + group_kept > settings.slots)  // the step will be repeated with more
      atomicOr(status.overflow, THESIS_SLOT_OVERFLOW);
  }
  barrier();
  if (kept == 0u) return;
  first += group_first_kept;
  touching_spheres[group_first_touching + at] = s;
  if (first + kept > settings.slots) return;
  contact_ranges[s] = ThesisRange(first, kept);
  for (uint i = 0u; i < kept; ++i) contacts[first + i] = contact_with(kept_other[i], s, body, world);
}
