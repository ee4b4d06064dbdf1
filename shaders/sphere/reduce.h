// Selects the candidates of one pair that become contacts, at most eight, by the rule of shared/sphere/choice.h. Twin:
// reduce.hpp. Needs the bindings Settings, Progress, States, Manifolds, Contacts, Jobs, Candidates, world_index,
// samples_of() and placement_of().

#include "shared/sphere/choice.h"

const float FAR = 3.4e38;

shared SphereContact old[SPHERE_MAX_CONTACTS];
shared uint old_count, old_found;
shared vec4 chosen_on_a[SPHERE_MAX_CONTACTS];  // w: separation
shared vec3 chosen_normal[SPHERE_MAX_CONTACTS];
shared uint chosen_feature[SPHERE_MAX_CONTACTS];
shared uint chosen_source[SPHERE_MAX_CONTACTS];  // contact of the last step whose forces it takes
shared uint source_taken[SPHERE_MAX_CONTACTS];
shared uint highest[2], highest_feature[2];      // take turns
shared uint found_count;
const uint NO_SOURCE = 0xffffffffu;

uint chain;  // the first candidate that is this invocation's
#define FOR_OWN_CANDIDATES(at) for (uint at = chain; at != 0u; at = candidates[at].next)

// A job leaves its chains empty.
void take_chain(uint job) {
  uint i = gl_LocalInvocationIndex;
  chain = 0u;
  if (i >= SPHERE_CHAINS) return;
  chain = jobs[job].chains[i];
  jobs[job].chains[i] = 0u;
}

// Known to all behind the next barrier.
void begin_choice(SphereWorld world, uint slot) {
  uint thread = gl_LocalInvocationIndex;
  SphereManifold manifold = manifolds[world.pairs.x + slot];
  uint count = manifold.state.x;
  if (thread == 0u) {
    old_count = count;
    old_found = manifold.state.z;
    highest[0] = 0u;
    highest_feature[0] = NO_SOURCE;
    found_count = 0u;
  }
  if (thread < count) {
    old[thread] = contacts[SPHERE_MAX_CONTACTS * (world.pairs.x + slot) + thread];
    source_taken[thread] = 0u;
  }
}

// Whether each was a contact in the last step; none is chosen.
void begin_candidates() {
  uint count = 0u;
  FOR_OWN_CANDIDATES(at) {
    uint feature = candidates[at].feature;
    for (uint k = 0u; k < old_count; ++k)
      if (old_found != 0u && old[k].feature == feature) candidates[at].known = 1u;
    candidates[at].apart = FAR;
    ++count;
  }
  atomicAdd(found_count, count);
}

// The candidate with the largest key of all invocations, ties by feature, becomes number n of the chosen; false if
// every key is 0.
bool choose(uint n, uint key, uint at) {
  uint turn = n & 1u, feature = NO_SOURCE;
  if (key > 0u) {
    feature = candidates[at].feature;
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
    chosen_on_a[n] = vec4(candidates[at].on_a, candidates[at].separation);
    chosen_normal[n] = candidates[at].normal;
    chosen_feature[n] = feature;
    candidates[at].apart = -1.0;
  }
  barrier();
  return true;
}

// Floats as keys: larger keys for smaller separations.
uint depth_key(float separation) {
  uint bits = floatBitsToUint(separation);
  return (bits & 0x80000000u) != 0u ? bits : ~(bits | 0x80000000u);
}

// Whether a candidate with this key comes before the best so far.
bool is_better(uint key, uint feature, uint best_key, uint best) {
  return key > best_key || key == best_key && key > 0u && feature < candidates[best].feature;
}

// The few candidates that represent all (shared/sphere/choice.h).
uint reduce(float size, float soon) {
  uint key = 0u, best = 0u;
  FOR_OWN_CANDIDATES(at) {
    uint depth = depth_key(candidates[at].separation);
    if (!is_better(depth, candidates[at].feature, key, best)) continue;
    key = depth;
    best = at;
  }
  uint n = 0u;
  while (choose(n, key, best)) {
    if (++n == SPHERE_MAX_CONTACTS) break;
    key = 0u;
    vec3 on_a = chosen_on_a[n - 1u].xyz, normal = chosen_normal[n - 1u];
    FOR_OWN_CANDIDATES(at) {
      SphereCandidate c = candidates[at];
      if (c.apart < 0.0) continue;
      float apart = min(c.apart, distance_between(c.on_a, c.normal, on_a, normal, size));
      if (apart < TWIN * size) apart = -1.0;
      candidates[at].apart = apart;
      if (apart < 0.0) continue;
      float gap = gap_of(c.separation, chosen_on_a[0].w);
      float score = worth_of(gap, soon, size) * (apart + advantage_of(c.separation, gap, c.known != 0u, size));
      uint value = score > 0.0 ? floatBitsToUint(score) : 0u;
      if (!is_better(value, c.feature, key, best)) continue;
      key = value;
      best = at;
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
        float moved = length(old[k].anchor_a - chosen_on_a[n].xyz);
        if (source_taken[k] == 1u || moved > nearest) continue;
        bool field_of_a = (old[k].feature & SPHERE_SIDE_B) != 0u;
        vec3 normal = old[k].normal.xyz;
        if (!field_of_a) normal = (ground ? normal : rb * normal) * ra;
        if (dot(normal, chosen_normal[n]) < ALIKE) continue;
        chosen_source[n] = k;
        nearest = moved;
      }
      if (chosen_source[n] != NO_SOURCE) source_taken[chosen_source[n]] = 1u;
    }
  }
  barrier();
}

// One invocation, when `count` contacts of those found are chosen.
void end_choice(SphereWorld world, SpherePair pair, uint count) {
  vec3 position;
  vec4 orientation;
  relative_pose(pair, position, orientation);
  manifolds[world.pairs.x + pair.slot] = SphereManifold(uvec4(count, 0u, 1u, count), position, 0u, orientation);
  if (count == 0u)
    atomicAdd(progress[world_index].pairs_culled, 1u);
  else
    atomicAdd(progress[world_index].dropped, found_count - count);
}

void choose_contacts(SphereWorld world, SpherePair pair) {
  uint thread = gl_LocalInvocationIndex;
  bool ground = pair.b == SPHERE_GROUND;
  Placement a = placement_of(pair.a), b = Placement(vec3(0.0), mat3(1.0));
  if (!ground) b = placement_of(pair.b);
  mat3 ra = a.rotation, rb = b.rotation;
  float size = size_of(pair);
  // What is fast may meet all that is within its travel.
  float soon = SOON * size + max(0.0, travel_of(world, pair) - settings.margin * size);
  uint count = reduce(size, soon);
  carry_forces(count, samples_of(pair.a).size.y, ra, rb, ground);
  if (thread < count) {
    vec3 on_a = chosen_on_a[thread].xyz, normal = chosen_normal[thread];
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
  if (thread == 0u) end_choice(world, pair, count);
}
