// Selects the candidates of a pair that become contacts, at most eight, by the rule of shared/sphere/choice.h. A team of
// TEAM invocations takes a pair, and all teams of the group go through the rounds together. Twin: reduce.hpp. Needs the
// bindings Settings, Progress, States, Manifolds, Contacts, Jobs, Candidates, world_index, samples_of() and
// placement_of().

#include "shared/sphere/choice.h"

const float FAR = 3.4e38;
const uint TEAM = SPHERE_CHAINS, TEAMS = SPHERE_PAIR_GROUP / TEAM;
const uint TEAM_CONTACTS = TEAMS * SPHERE_MAX_CONTACTS;
const uint NO_SOURCE = 0xffffffffu;

shared SphereContact old[TEAM_CONTACTS];
shared vec4 chosen_on_a[TEAM_CONTACTS];  // w: separation
shared vec3 chosen_normal[TEAM_CONTACTS];
shared uint chosen_feature[TEAM_CONTACTS];
shared uint chosen_source[TEAM_CONTACTS];  // contact of the last step whose forces it takes
shared uint source_taken[TEAM_CONTACTS];
shared uint highest[2u * TEAMS], highest_feature[2u * TEAMS];  // take turns
shared uint found_count[TEAMS];
shared uint goes_on[2];  // take turns; 1: a team has chosen one

uint team, member;  // of this invocation: number of the team, and number in it
uint team_old;      // where those of its pair's last contacts begin, and of the chosen ones
uint old_count;     // of those
bool old_known;     // whether they have features of the present samples
uint chain;         // the first candidate that is this invocation's
#define FOR_OWN_CANDIDATES(at) for (uint at = chain; at != 0u; at = candidates[at].next)

void join_team() {
  team = gl_LocalInvocationIndex / TEAM;
  member = gl_LocalInvocationIndex % TEAM;
  team_old = team * SPHERE_MAX_CONTACTS;
}

// A job leaves its chains empty.
void take_chain(uint job) {
  chain = jobs[job].chains[member];
  jobs[job].chains[member] = 0u;
}

// Known to all behind the next barrier. slot: of the manifold, in all worlds.
void begin_choice(bool has_pair, uint slot) {
  old_count = 0u;
  if (has_pair) old_count = manifolds[slot].state.x;
  old_known = old_count > 0u && manifolds[slot].state.z != 0u;
  if (member == 0u) {
    highest[2u * team] = 0u;
    highest_feature[2u * team] = NO_SOURCE;
    found_count[team] = 0u;
  }
  if (member < old_count) {
    old[team_old + member] = contacts[SPHERE_MAX_CONTACTS * slot + member];
    source_taken[team_old + member] = 0u;
  }
}

// Whether each was a contact in the last step; none is chosen.
void begin_candidates() {
  uint count = 0u;
  FOR_OWN_CANDIDATES(at) {
    uint feature = candidates[at].feature;
    for (uint k = 0u; old_known && k < old_count; ++k)
      if (old[team_old + k].feature == feature) candidates[at].known = 1u;
    candidates[at].apart = FAR;
    ++count;
  }
  if (count > 0u) atomicAdd(found_count[team], count);
}

// The candidate with the largest key of a team, ties by feature, becomes number n of its chosen ones; false if every
// key is 0. All invocations: goes_on[n & 1] tells whether a team has chosen one.
bool choose(uint n, uint key, uint at) {
  uint turn = 2u * team + (n & 1u), feature = NO_SOURCE;
  if (key > 0u) {
    feature = candidates[at].feature;
    atomicMax(highest[turn], key);
  }
  barrier();
  bool is_highest = key > 0u && key == highest[turn], chooses = highest[turn] != 0u;
  if (is_highest) atomicMin(highest_feature[turn], feature);
  if (member == 0u) {
    highest[turn ^ 1u] = 0u;
    highest_feature[turn ^ 1u] = NO_SOURCE;
    if (chooses) goes_on[n & 1u] = 1u;
  }
  if (gl_LocalInvocationIndex == 0u) goes_on[~n & 1u] = 0u;
  barrier();
  if (is_highest && feature == highest_feature[turn]) {
    chosen_on_a[team_old + n] = vec4(candidates[at].on_a, candidates[at].separation);
    chosen_normal[team_old + n] = candidates[at].normal;
    chosen_feature[team_old + n] = feature;
    candidates[at].apart = -1.0;
  }
  barrier();
  return chooses;
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

// The candidate of this invocation with the best score beside those chosen so far, and its score as a key.
uint best_beside(uint chosen, float size, float soon, out uint best) {
  uint key = best = 0u;
  vec3 on_a = chosen_on_a[team_old + chosen - 1u].xyz, normal = chosen_normal[team_old + chosen - 1u];
  FOR_OWN_CANDIDATES(at) {
    SphereCandidate c = candidates[at];
    if (c.apart < 0.0) continue;
    float apart = min(c.apart, distance_between(c.on_a, c.normal, on_a, normal, size));
    if (apart < TWIN * size) apart = -1.0;
    candidates[at].apart = apart;
    if (apart < 0.0) continue;
    float gap = gap_of(c.separation, chosen_on_a[team_old].w);
    float score = worth_of(gap, soon, size) * (apart + advantage_of(c.separation, gap, c.known != 0u, size));
    uint value = score > 0.0 ? floatBitsToUint(score) : 0u;
    if (!is_better(value, c.feature, key, best)) continue;
    key = value;
    best = at;
  }
  return key;
}

// The few candidates that represent all (shared/sphere/choice.h).
uint reduce(float size, float soon) {
  uint key = 0u, best = 0u, count = 0u;
  FOR_OWN_CANDIDATES(at) {
    uint depth = depth_key(candidates[at].separation);
    if (!is_better(depth, candidates[at].feature, key, best)) continue;
    key = depth;
    best = at;
  }
  for (uint n = 0u; n < SPHERE_MAX_CONTACTS; ++n) {
    bool chooses = choose(n, key, best);
    if (goes_on[n & 1u] == 0u) break;
    key = 0u;
    if (!chooses) continue;
    ++count;
    if (count < SPHERE_MAX_CONTACTS) key = best_beside(count, size, soon, best);
  }
  return count;
}

// Forces of the last step's contacts: by feature, else from the nearest with a like normal. Known to all behind the next
// barrier.
void carry_forces(uint count, float near, mat3 ra, mat3 rb, bool ground) {
  if (member < count) {
    chosen_source[team_old + member] = NO_SOURCE;
    for (uint k = 0u; old_known && k < old_count; ++k)
      if (old[team_old + k].feature == chosen_feature[team_old + member]) {
        chosen_source[team_old + member] = k;
        source_taken[team_old + k] = 1u;
      }
  }
  barrier();
  if (member == 0u) {
    for (uint n = team_old; n < team_old + count; ++n) {
      if (chosen_source[n] != NO_SOURCE) continue;
      float nearest = near;
      for (uint k = 0u; k < old_count; ++k) {
        SphereContact last = old[team_old + k];
        float moved = length(last.anchor_a - chosen_on_a[n].xyz);
        if (source_taken[team_old + k] == 1u || moved > nearest) continue;
        bool field_of_a = (last.feature & SPHERE_SIDE_B) != 0u;
        vec3 normal = last.normal.xyz;
        if (!field_of_a) normal = (ground ? normal : rb * normal) * ra;
        if (dot(normal, chosen_normal[n]) < ALIKE) continue;
        chosen_source[n] = k;
        nearest = moved;
      }
      if (chosen_source[n] != NO_SOURCE) source_taken[team_old + chosen_source[n]] = 1u;
    }
  }
  barrier();
}

// One invocation, when `count` contacts of `found` candidates are chosen.
void end_choice(SphereWorld world, SpherePair pair, uint count, uint found) {
  vec3 position;
  vec4 orientation;
  relative_pose(pair, position, orientation);
  manifolds[world.pairs.x + pair.slot] = SphereManifold(uvec4(count, 0u, 1u, count), position, 0u, orientation);
  if (count == 0u)
    atomicAdd(progress[world_index].pairs_culled, 1u);
  else
    atomicAdd(progress[world_index].dropped, found - count);
}

// Contact number `member` of the chosen ones.
void write_contact(SphereWorld world, SpherePair pair, Placement a, Placement b) {
  bool ground = pair.b == SPHERE_GROUND;
  uint n = team_old + member, feature = chosen_feature[n];
  vec3 on_a = chosen_on_a[n].xyz, normal = chosen_normal[n];
  vec3 on_b = a.position + a.rotation * (on_a + chosen_on_a[n].w * normal);
  if (!ground) on_b = (on_b - b.position) * b.rotation;
  // The normal turns with the body whose field it comes from.
  if ((feature & SPHERE_SIDE_B) == 0u) normal = ground ? a.rotation * normal : (a.rotation * normal) * b.rotation;
  uint at = SPHERE_MAX_CONTACTS * (world.pairs.x + pair.slot) + member, source = chosen_source[n];
  contacts[at].anchor_a = on_a;
  contacts[at].anchor_b = on_b;
  contacts[at].feature = feature;
  contacts[at].normal = vec4(normal, 0.0);
  contacts[at].force = source != NO_SOURCE ? old[team_old + source].force : vec4(0.0);
}

// All invocations. Where a team has no pair, the pair is any one, and it has no candidates.
void choose_contacts(SpherePair pair, bool has_pair) {
  SphereWorld world = worlds[world_index];
  bool ground = pair.b == SPHERE_GROUND;
  Placement a = placement_of(pair.a), b = Placement(vec3(0.0), mat3(1.0));
  if (!ground) b = placement_of(pair.b);
  float size = size_of(pair);
  // What is fast may meet all that is within its travel.
  float soon = SOON * size + max(0.0, travel_of(world, pair) - settings.margin * size);
  uint count = reduce(size, soon);
  carry_forces(count, samples_of(pair.a).size.y, a.rotation, b.rotation, ground);
  if (member < count) write_contact(world, pair, a, b);
  if (member == 0u && has_pair) end_choice(world, pair, count, found_count[team]);
}
