// Selects the candidates of a pair that become contacts, at most eight, by the rule of shared/sphere/choice.h. A team
// of TEAM invocations processes a pair, and all teams of the group run each round together. Twin: reduce.hpp. Needs the
// bindings Settings, Progress, States, Manifolds, Contacts, Jobs, Candidates, world_index, samples_of() and
// placement_of().

#include "shared/sphere/choice.h"

const float FAR = 3.4e38;
const uint TEAM = SPHERE_CHAINS, TEAMS = SPHERE_PAIR_GROUP / TEAM;
const uint TEAM_CONTACTS = TEAMS * SPHERE_MAX_CONTACTS;
const uint NO_SOURCE = 0xffffffffu;

shared SphereContact old[TEAM_CONTACTS];   // contacts of the last step
shared vec4 chosen_on_a[TEAM_CONTACTS];  // of the chosen candidates: SphereCandidate.on_a (m); w: separation (m)
shared vec3 chosen_normal[TEAM_CONTACTS];  // unit normals in the frame of a
shared uint chosen_feature[TEAM_CONTACTS];
shared uint chosen_source[TEAM_CONTACTS];  // number of the contact of the last step whose forces a chosen one inherits
shared uint source_taken[TEAM_CONTACTS];   // 1: the forces of this contact of the last step are inherited
shared uint highest[2u * TEAMS], highest_feature[2u * TEAMS];  // best key of a round; even and odd rounds alternate
shared uint found_count[TEAMS];            // number of candidates of the pair
shared uint goes_on[2];  // 1: a team has chosen a candidate; even and odd rounds alternate

uint team, member;  // number of this invocation's team, and of the invocation in the team
uint team_old;      // index of the team's first element in the arrays of TEAM_CONTACTS elements
uint old_count;     // number of contacts of the pair in the last step
bool old_known;     // whether the features of these contacts denote samples of the set that is in use
uint chain;         // index of the first candidate in the chain of this invocation; 0: none
#define FOR_OWN_CANDIDATES(at) for (uint at = chain; at != 0u; at = candidates[at].next)

void join_team() {
  team = gl_LocalInvocationIndex / TEAM;
  member = gl_LocalInvocationIndex % TEAM;
  team_old = team * SPHERE_MAX_CONTACTS;
}

// Gets the chain of this invocation from a job, and leaves it empty for the next step.
void take_chain(uint job) {
  chain = jobs[job].chains[member];
  jobs[job].chains[member] = 0u;
}

// Reads the contacts of the last step into shared memory; valid after the next barrier. slot: index of the manifold.
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

// Determines for each candidate whether it was a contact in the last step, and marks it as not chosen.
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

// Stores the candidate with the largest key of the team (of equal keys, the lowest feature) as chosen candidate n.
// Returns false if all keys are 0. Called by all invocations; then goes_on[n & 1] states whether a team has chosen one.
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

// Converts a separation to an integer key, which is larger for a smaller separation.
uint depth_key(float separation) {
  uint bits = floatBitsToUint(separation);
  return (bits & 0x80000000u) != 0u ? bits : ~(bits | 0x80000000u);
}

// Returns whether a candidate with this key and feature is chosen before the best one so far.
bool is_better(uint key, uint feature, uint best_key, uint best) {
  return key > best_key || key == best_key && key > 0u && feature < candidates[best].feature;
}

// Finds the candidate of this invocation with the best score, given those chosen so far. Returns its score as a key.
uint best_beside(uint chosen, Approach approach, float size, float soon, out uint best) {
  uint key = best = 0u;
  vec3 on_a = chosen_on_a[team_old + chosen - 1u].xyz, normal = chosen_normal[team_old + chosen - 1u];
  FOR_OWN_CANDIDATES(at) {
    SphereCandidate c = candidates[at];
    if (c.apart < 0.0) continue;
    float apart = min(c.apart, distance_between(c.on_a, c.normal, on_a, normal, size));
    if (apart < TWIN * size) apart = -1.0;
    candidates[at].apart = apart;
    if (apart < 0.0) continue;
    float gap = gap_of(approach, c.on_a, c.normal, c.separation, chosen_on_a[team_old].w, size);
    float score = worth_of(gap, soon, size) * (apart + advantage_of(c.separation, gap, c.known != 0u, size));
    uint value = score > 0.0 ? floatBitsToUint(score) : 0u;
    if (!is_better(value, c.feature, key, best)) continue;
    key = value;
    best = at;
  }
  return key;
}

// Chooses the candidates that become contacts (shared/sphere/choice.h). Returns their number. size, soon: m.
uint reduce(Approach approach, float size, float soon) {
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
    if (count < SPHERE_MAX_CONTACTS) key = best_beside(count, approach, size, soon, best);
  }
  return count;
}

// Finds for each chosen candidate the contact of the last step whose forces it inherits: that with the same feature, or
// the nearest one within `near` (m) with a similar normal. ra, rb: rotations from body axes to world axes.
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

// Called by one invocation of a team when `count` contacts of `found` candidates are chosen. Stores the manifold.
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

// Stores contact number `member` of the chosen ones.
void write_contact(SphereWorld world, SpherePair pair, Placement a, Placement b) {
  bool ground = pair.b == SPHERE_GROUND;
  uint n = team_old + member, feature = chosen_feature[n];
  vec3 on_a = chosen_on_a[n].xyz, normal = chosen_normal[n];
  vec3 on_b = a.position + a.rotation * (on_a + chosen_on_a[n].w * normal);
  if (!ground) on_b = (on_b - b.position) * b.rotation;
  // The normal is stored in the frame of the body whose field determined it, and rotates with this body.
  if ((feature & SPHERE_SIDE_B) == 0u) normal = ground ? a.rotation * normal : (a.rotation * normal) * b.rotation;
  uint at = SPHERE_MAX_CONTACTS * (world.pairs.x + pair.slot) + member, source = chosen_source[n];
  contacts[at].anchor_a = on_a;
  contacts[at].anchor_b = on_b;
  contacts[at].feature = feature;
  contacts[at].normal = vec4(normal, 0.0);
  contacts[at].force = source != NO_SOURCE ? old[team_old + source].force : vec4(0.0);
}

// Returns the motion of b, or of the ground, relative to a in this step, without gravity. Twin: find_contacts.cpp.
Approach approach_of(SpherePair pair, Placement a, Placement b) {
  vec3 v = vec3(0.0), w = vec3(0.0);
  if (moves(pair.a)) {
    v = -states[pair.a].velocity.xyz;
    w = -states[pair.a].spin.xyz;
  }
  if (pair.b != SPHERE_GROUND && moves(pair.b)) {
    vec3 spin = states[pair.b].spin.xyz;
    v += states[pair.b].velocity.xyz + cross(spin, a.position - b.position);
    w += spin;
  }
  return Approach(time_step * (v * a.rotation), time_step * (w * a.rotation));
}

// Chooses and stores the contacts of a pair. Called by all invocations; a team without a pair gives any pair.
void choose_contacts(SpherePair pair, bool has_pair) {
  SphereWorld world = worlds[world_index];
  bool ground = pair.b == SPHERE_GROUND;
  Placement a = placement_of(pair.a), b = Placement(vec3(0.0), mat3(1.0));
  if (!ground) b = placement_of(pair.b);
  float size = size_of(pair);
  // A fast pair may close any gap that is smaller than its travel.
  float soon = SOON * size + max(0.0, travel_of(world, pair) - settings.margin * size);
  uint count = reduce(approach_of(pair, a, b), size, soon);
  carry_forces(count, samples_of(pair.a).size.y, a.rotation, b.rotation, ground);
  if (member < count) write_contact(world, pair, a, b);
  if (member == 0u && has_pair) end_choice(world, pair, count, found_count[team]);
}
