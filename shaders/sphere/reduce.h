// Candidates of one pair, found by all invocations of a group, and the few of them that become contacts. Needs the
// bindings Settings, Progress, States, Manifolds, Contacts, Candidates, world_index, samples_of() and
// placement_of().

#include "shared/sphere/choice.h"

const float FAR = 3.4e38;

shared SphereContact old[SPHERE_MAX_CONTACTS];
shared uint old_count, old_found;
shared vec4 chosen_on_a[SPHERE_MAX_CONTACTS], chosen_normal[SPHERE_MAX_CONTACTS];  // w: separation
shared uint chosen_feature[SPHERE_MAX_CONTACTS];
shared uint chosen_source[SPHERE_MAX_CONTACTS];  // contact of the last step whose forces it takes
shared uint source_taken[SPHERE_MAX_CONTACTS];
shared uint highest[2], highest_feature[2];      // take turns
shared uint found_count, any_lost;
const uint NO_SOURCE = 0xffffffffu;

uint mine;  // candidates of this invocation
bool lost;

// Rooms for the candidates of a group lie behind a word for each that says whether it is in use.
shared uint room;

// Known to all behind the next barrier.
void take_room() {
  if (gl_LocalInvocationIndex == 0u) {
    room = gl_WorkGroupID.x % settings.contact_groups;
    while (atomicExchange(candidates[room].feature.x, 1u) == 1u) room = (room + 1u) % settings.contact_groups;
  }
  memoryBarrierBuffer();
}
// What this group wrote there is written before the next one takes the room.
void leave_room() {
  memoryBarrierBuffer();
  barrier();
  if (gl_LocalInvocationIndex == 0u) atomicExchange(candidates[room].feature.x, 0u);
}

// Side by side for neighbours, so that a group's reads are one.
uint candidate_place(uint k) {
  return settings.contact_groups + (room * settings.candidates + k) * SPHERE_PAIR_GROUP + gl_LocalInvocationIndex;
}

void begin_candidates(SphereWorld world, uint slot) {
  uint thread = gl_LocalInvocationIndex;
  mine = 0u;
  lost = false;
  SphereManifold manifold = manifolds[world.pairs.x + slot];
  uint count = manifold.state.x;
  if (thread == 0u) {
    old_count = count;
    old_found = manifold.state.z;
    highest[0] = 0u;
    highest_feature[0] = NO_SOURCE;
    found_count = any_lost = 0u;
  }
  if (thread < count) {
    old[thread] = contacts[SPHERE_MAX_CONTACTS * (world.pairs.x + slot) + thread];
    source_taken[thread] = 0u;
  }
  barrier();
}

void emit(vec3 on_a, vec3 normal, float separation, uint feature) {
  if (mine == settings.candidates) {
    lost = true;
    return;
  }
  uint known = 0u;
  for (uint k = 0u; k < old_count; ++k)
    if (old_found != 0u && old[k].feature == feature) known = 1u;
  candidates[candidate_place(mine++)] =
      SphereCandidate(vec4(on_a, separation), vec4(normal, FAR), uvec4(feature, known, 0u, 0u));
}

// 64-bit sum, for what a big world counts beyond 2^32 between two observations.
void count_possible(uint n) {
  uint before = atomicAdd(progress[world_index].nodes_possible, n);
  if (before + n < before) atomicAdd(progress[world_index].nodes_possible_high, 1u);
}

// The candidate with the largest key of all invocations, ties by feature, becomes number n of the chosen; false if
// every key is 0.
bool choose(uint n, uint key, uint k) {
  uint turn = n & 1u, feature = NO_SOURCE;
  if (key > 0u) {
    feature = candidates[candidate_place(k)].feature.x;
    atomicMax(highest[turn], key);
  }
  barrier();
  if (key > 0u && key == highest[turn]) atomicMin(highest_feature[turn], feature);
  if (gl_LocalInvocationIndex == 0u) {
    highest[turn ^ 1u] = 0u;
    highest_feature[turn ^ 1u] = NO_SOURCE;
  }
  barrier();
  if (highest[turn] == 0u) return false;
  if (key == highest[turn] && feature == highest_feature[turn]) {
    SphereCandidate c = candidates[candidate_place(k)];
    chosen_on_a[n] = c.on_a;
    chosen_normal[n] = c.normal;
    chosen_feature[n] = feature;
    candidates[candidate_place(k)].normal.w = -1.0;
  }
  barrier();
  return true;
}

// Floats as keys: larger keys for smaller separations.
uint depth_key(float separation) {
  uint bits = floatBitsToUint(separation);
  return (bits & 0x80000000u) != 0u ? bits : ~(bits | 0x80000000u);
}

// The few candidates that stand for all (shared/sphere/choice.h).
uint reduce(float size, float soon) {
  uint key = 0u, best = 0u;
  for (uint k = 0u; k < mine; ++k) {
    SphereCandidate c = candidates[candidate_place(k)];
    uint depth = depth_key(c.on_a.w);
    if (depth > key || depth == key && c.feature.x < candidates[candidate_place(best)].feature.x) {
      key = depth;
      best = k;
    }
  }
  uint n = 0u;
  while (choose(n, key, best)) {
    if (++n == SPHERE_MAX_CONTACTS) break;
    key = 0u;
    vec3 on_a = chosen_on_a[n - 1u].xyz, normal = chosen_normal[n - 1u].xyz;
    for (uint k = 0u; k < mine; ++k) {
      SphereCandidate c = candidates[candidate_place(k)];
      if (c.normal.w < 0.0) continue;
      float apart = min(c.normal.w, way_between(c.on_a.xyz, c.normal.xyz, on_a, normal, size));
      if (apart < TWIN * size) apart = -1.0;
      candidates[candidate_place(k)].normal.w = apart;
      if (apart < 0.0) continue;
      float gap = gap_of(c.on_a.w, chosen_on_a[0].w);
      float score = worth_of(gap, soon, size) * (apart + advantage_of(c.on_a.w, gap, c.feature.y != 0u, size));
      uint value = score > 0.0 ? floatBitsToUint(score) : 0u;
      if (value > key || value == key && value > 0u && c.feature.x < candidates[candidate_place(best)].feature.x) {
        key = value;
        best = k;
      }
    }
  }
  return n;
}

// Forces of the last step's contacts: by feature, else from the nearest with a like normal. Known to all behind the next
// barrier.
void carry_forces(uint count, float near, mat3 ra, mat3 rb, bool ground) {
  uint i = gl_LocalInvocationIndex;
  if (i < count) {
    chosen_source[i] = NO_SOURCE;
    for (uint k = 0u; k < old_count; ++k)
      if (old_found != 0u && old[k].feature == chosen_feature[i]) {
        chosen_source[i] = k;
        source_taken[k] = 1u;
      }
  }
  barrier();
  if (i == 0u) {
    for (uint n = 0u; n < count; ++n) {
      if (chosen_source[n] != NO_SOURCE) continue;
      float nearest = near;
      for (uint k = 0u; k < old_count; ++k) {
        float way = length(old[k].anchor_a - chosen_on_a[n].xyz);
        if (source_taken[k] == 1u || way > nearest) continue;
        bool field_of_a = (old[k].feature & SPHERE_SIDE_B) != 0u;
        vec3 normal = old[k].normal.xyz;
        if (!field_of_a) normal = (ground ? normal : rb * normal) * ra;
        if (dot(normal, chosen_normal[n].xyz) < ALIKE) continue;
        chosen_source[n] = k;
        nearest = way;
      }
      if (chosen_source[n] != NO_SOURCE) source_taken[chosen_source[n]] = 1u;
    }
  }
  barrier();
}

void finish_candidates(SphereWorld world, SpherePair pair) {
  uint thread = gl_LocalInvocationIndex;
  bool ground = pair.b == SPHERE_GROUND;
  Placement a = placement_of(pair.a), b = Placement(vec3(0.0), mat3(1.0));
  if (!ground) b = placement_of(pair.b);
  mat3 ra = a.rotation, rb = b.rotation;
  if (lost) any_lost = 1u;
  atomicAdd(found_count, mine);
  float size = size_of(pair);
  // What is fast may meet all that is within its way.
  float soon = SOON * size + max(0.0, way_of(world, pair) - settings.margin * size);
  uint count = reduce(size, soon);
  carry_forces(count, spacing_of(samples_of(pair.a)), ra, rb, ground);
  if (any_lost != 0u) {  // the step is repeated with more places, from the contacts of the last step
    if (thread == 0u) atomicOr(progress[world_index].overflow, SPHERE_CANDIDATE_OVERFLOW);
    return;
  }
  if (thread < count) {
    vec3 on_a = chosen_on_a[thread].xyz, normal = chosen_normal[thread].xyz;
    vec3 on_b = a.position + ra * (on_a + chosen_on_a[thread].w * normal);
    if (!ground) on_b = (on_b - b.position) * rb;
    // The normal turns with the body whose field it comes from.
    if ((chosen_feature[thread] & SPHERE_SIDE_B) == 0u) normal = ground ? ra * normal : (ra * normal) * rb;
    uint at = SPHERE_MAX_CONTACTS * (world.pairs.x + pair.slot) + thread, source = chosen_source[thread];
    contacts[at].anchor_a = on_a;
    contacts[at].anchor_b = on_b;
    contacts[at].feature = chosen_feature[thread];
    contacts[at].normal = vec4(normal, 0.0);
    contacts[at].force = source != NO_SOURCE ? old[source].force : vec4(0.0);
  }
  if (thread == 0u) {
    vec3 position;
    vec4 orientation;
    relative_pose(pair, position, orientation);
    manifolds[world.pairs.x + pair.slot] =
        SphereManifold(uvec4(count, 0u, 1u, 0u), position, 0u, orientation);
    atomicAdd(progress[world_index].dropped, found_count - count);
    if (found_count == 0u) atomicAdd(progress[world_index].pairs_culled, 1u);
  }
}
