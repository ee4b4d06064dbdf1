// Puts manifolds in the order in which they are solved: by color and, within a color, by decreasing number of visits of
// contacts, so that neighbouring invocations have equal work. The includer defines members_of(k), the number of
// manifolds of a color with a number of visits (k = kind_of()), and later the position of the next of them;
// members_in(c), the number of manifolds of a color; start_of(c), the position of its first one; row_top, the number of
// vec4 in the rows assigned so far; longest_visits, the sum over blocks of their largest number of visits. Needs the
// bindings Bodies, States, Pairs, Manifolds, Order, and sphere/color.h.
#include "sphere/ordered.h"

const uint VISIT_KINDS = MOST_VISITS + 1u;

uint kind_of(uint color, uint visits) { return color * VISIT_KINDS + MOST_VISITS - visits; }

uint contacts_of(SphereWorld world, uint p) { return manifolds[world.pairs.x + pairs[p].slot].state.x; }

// Returns the number of contacts of pair p that this step solves; 0 if neither body moves.
uint contacts_to_solve(SphereWorld world, uint p) {
  SpherePair pair = pairs[p];
  bool waits = !moves(pair.a) && (pair.b == SPHERE_GROUND || !moves(pair.b));
  return waits ? 0u : contacts_of(world, p);
}

// Counts a manifold that has got its color.
void count_member(SphereWorld world, uint p, uint color) { 
  SpherePair pair = pairs[p];  // copied, because an element of a coherent buffer cannot be an argument
  atomicAdd(members_of(kind_of(color, visits_of(world, pair))), 1u);
}

// Returns the number of manifolds in a block of rows; those of the last color are solved one by one, in order of pairs.
uint block_of(uint color) { return color == LAST_COLOR ? 1u : SPHERE_ROW_BLOCK; }

// Called by all invocations. Counts the manifolds of each color; members_of() becomes the first position per visits.
void count_colors() {
  for (uint c = gl_LocalInvocationIndex; c < SPHERE_COLORS; c += gl_WorkGroupSize.x) {
    uint sum = 0u;
    for (uint visits = MOST_VISITS + 1u; visits > 0u; --visits) {
      uint own = members_of(kind_of(c, visits - 1u));
      members_of(kind_of(c, visits - 1u)) = sum;
      sum += own;
    }
    members_in(c) = sum;
  }
}

// Stores a manifold at position `index` of its color. Its rows are assigned later (note_length, take_rows, join_block).
void put_in_order(SphereWorld world, SpherePair pair, uint count, uint index) {
  uint block = block_of(pair.color), lane = index % block, stride = min(block, members_in(pair.color) - (index - lane));
  uint b = pair.b == SPHERE_GROUND ? SPHERE_GROUND_BODY : pair.b - world.bodies.x;
  if (lane == 0u) atomicAdd(longest_visits, visits_of(world, pair));
  order[world.pairs.x + start_of(pair.color) + index] = SphereOrdered(
      pack_bodies(pair.a - world.bodies.x, b), 0u, pack_kind(lane, count, stride, 0u), 0.0, 0.0, 0.0, 0.0, pair.slot);
}

void put_in_order(SphereWorld world, uint p) {
  SpherePair pair = pairs[p];
  if (pair.color >= LAST_COLOR) return;
  uint visits = visits_of(world, pair);
  put_in_order(world, pair, contacts_of(world, p), atomicAdd(members_of(kind_of(pair.color, visits)), 1u));
}

// Called by one invocation. Manifolds of the last color are solved one by one, so that their order must be fixed.
void put_last_in_order(SphereWorld world, uint list, uint count) {
  uint index = 0u;
  for (uint p = list; index < members_in(LAST_COLOR) && p < list + count; ++p) {
    SpherePair pair = pairs[p];  // copied, because an element of a coherent buffer cannot be an argument
    if (pair.color == LAST_COLOR) put_in_order(world, pair, contacts_of(world, p), index++);
  }
}

// Called when all manifolds are in order. Stores the largest number of contacts of a block with its first manifold.
void note_length(SphereWorld world, uint o) {
  uint at = world.pairs.x + o, kind = order[at].kind;
  atomicMax(order[at - lane_of(kind)].row, count_of(kind));
}

// Called after note_length(). The first manifold of a block reserves this number of rows for each manifold in it.
void take_rows(SphereWorld world, uint o) {
  uint at = world.pairs.x + o, kind = order[at].kind;
  if (lane_of(kind) == 0u) order[at].row = atomicAdd(row_top, SPHERE_ROW_PARTS * stride_of(kind) * order[at].row);
}

// Called after take_rows(). Stores the position of a manifold's rows, from that of the first manifold of its block.
void join_block(SphereWorld world, uint o) {
  uint at = world.pairs.x + o, lane = lane_of(order[at].kind);
  if (lane == 0u) return;
  order[at].row = order[at - lane].row + lane;
  order[at].kind = without_lane(order[at].kind);
}
