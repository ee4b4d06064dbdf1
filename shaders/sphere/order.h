// The order in which manifolds are solved: by color, of a color those with most contacts first, so that manifolds whose
// rows lie side by side have about as many. Whoever includes this says where lie members_of(k), the number of manifolds
// of a color and a length (k = kind_of()) and later where the next of them goes; members_in(c), that of a color; start_of(c),
// where it begins; row_count and row_top, the vec4 that rows take in all and those given out so far. Needs the bindings
// Bodies, States, Pairs, Manifolds, Order, and sphere/color.h.

uint kind_of(uint color, uint count) { return color * SPHERE_MAX_CONTACTS + SPHERE_MAX_CONTACTS - count; }

uint contacts_of(SphereWorld world, uint p) { return manifolds[world.pairs.x + pairs[p].slot].state.x; }

// Those that this step solves: none where nothing moves.
uint contacts_to_solve(SphereWorld world, uint p) {
  SpherePair pair = pairs[p];
  bool waits = !moves(pair.a) && (pair.b == SPHERE_GROUND || !moves(pair.b));
  return waits ? 0u : contacts_of(world, p);
}

// A manifold has its color.
void count_member(SphereWorld world, uint p, uint color) {
  atomicAdd(members_of(kind_of(color, contacts_of(world, p))), 1u);
}

// Manifolds without a color of their own are solved one by one, in the order of their pairs.
uint block_of(uint color) { return color == LAST_COLOR ? 1u : SPHERE_ROW_BLOCK; }

// One group: how many manifolds and rows each color has, and where in it those of each length begin.
void count_colors() {
  for (uint c = gl_LocalInvocationIndex; c < SPHERE_COLORS; c += gl_WorkGroupSize.x) {
    uint count = 0u, sum = 0u, first = 0u, vectors = 0u, block = block_of(c);
    for (uint n = 1u; n <= SPHERE_MAX_CONTACTS; ++n) count += members_of(kind_of(c, n));
    members_in(c) = count;
    for (uint n = SPHERE_MAX_CONTACTS; n > 0u; --n) {
      uint own = members_of(kind_of(c, n));
      members_of(kind_of(c, n)) = sum;
      sum += own;
      for (; first < sum; first += block) vectors += SPHERE_ROW_PARTS * n * min(block, count - first);
    }
    if (vectors > 0u) atomicAdd(row_count, vectors);
  }
}

// Manifold `index` of its color. The first of a block takes the rows of all of it; the others learn later where those
// are (join_block).
void put_in_order(SphereWorld world, SpherePair pair, uint count, uint index) {
  uint block = block_of(pair.color), lane = index % block, stride = min(block, members_in(pair.color) - (index - lane));
  uint row = lane == 0u ? atomicAdd(row_top, SPHERE_ROW_PARTS * stride * count) : 0u;
  order[world.pairs.x + start_of(pair.color) + index] =
      SphereOrdered(pair.a, pair.b, pair.slot, row, stride, count, lane, 0.0);
}

void put_in_order(SphereWorld world, uint p) {
  SpherePair pair = pairs[p];
  if (pair.color >= LAST_COLOR) return;
  uint count = contacts_of(world, p);
  put_in_order(world, pair, count, atomicAdd(members_of(kind_of(pair.color, count)), 1u));
}

// One invocation: those of the last color are solved one by one, so their order counts.
void put_last_in_order(SphereWorld world, uint list, uint count) {
  uint index = 0u;
  for (uint p = list; index < members_in(LAST_COLOR) && p < list + count; ++p) {
    SpherePair pair = pairs[p];  // a copy: what is coherent cannot be an argument
    if (pair.color == LAST_COLOR) put_in_order(world, pair, contacts_of(world, p), index++);
  }
}

// When all of the color are in order.
void join_block(SphereWorld world, uint o) {
  uint at = world.pairs.x + o, lane = order[at].flags;
  if (lane != 0u) order[at].row = order[at - lane].row + lane;
}
