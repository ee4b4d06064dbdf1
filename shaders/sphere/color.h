// Assigns colors to manifolds: the work of one invocation on one manifold. The includer defines lowest_of(i),
// used_low_of(i) and used_high_of(i) for body i of the world: the lowest key among the uncolored manifolds of the body,
// and bits of the colors that its manifolds have. Needs the bindings Bodies, States, Pairs, Manifolds, sphere/body.h.
const uint UNCOLORED = 0xfffffffeu, NOT_SOLVED = SPHERE_NO_COLOR;
const uint LAST_COLOR = SPHERE_COLORS - 1u;  // color whose manifolds may share bodies and are solved one by one

// Largest number of visits that a manifold needs in a sweep: one for the normal and one for the friction of a contact.
const uint MOST_VISITS = 2u * SPHERE_MAX_CONTACTS;

uint visits_of(SphereWorld world, SpherePair pair) { return manifolds[world.pairs.x + pair.slot].state.w; }

// Returns the key by which manifolds get their colors. It is unique for up to 16,384 bodies. Manifolds that need many
// visits are first, so that those of a color need similar numbers; then a hash decides. Each step of the hash is a
// one-to-one map of 28 bits (shortened finaliser of MurmurHash3).
uint key_of(SphereWorld world, SpherePair pair) {
  uint a = pair.a - world.bodies.x, b = pair.b == SPHERE_GROUND ? a : pair.b - world.bodies.x;
  uint key = a << 14 | b;
  key = (key ^ key >> 14) * 0x85ebca6bu & 0x0fffffffu;
  key = (key ^ key >> 13) * 0xc2b2ae35u & 0x0fffffffu;
  return min(MOST_VISITS - visits_of(world, pair), 15u) << 28 | key ^ key >> 14;
}

uint lowest_free(uvec2 used) {
  if (used.x != 0xffffffffu) return uint(findLSB(~used.x));
  return used.y != 0xffffffffu ? 32u + uint(findLSB(~used.y)) : LAST_COLOR;
}

uvec2 color_bit(uint color) { return color < 32u ? uvec2(1u << color, 0u) : uvec2(0u, 1u << (color - 32u)); }

// Lowers the lowest key of both bodies to the key of a manifold. Returns false if the manifold has a color already.
bool bid(SphereWorld world, uint p) {
  SpherePair pair = pairs[p];
  if (pair.color != UNCOLORED) return false;
  uint key = key_of(world, pair);
  if (moves(pair.a)) atomicMin(lowest_of(pair.a - world.bodies.x), key);
  if (pair.b != SPHERE_GROUND && moves(pair.b)) atomicMin(lowest_of(pair.b - world.bodies.x), key);
  return true;
}

// Gives a manifold its color if it has the lowest key of both bodies. Returns the color, or UNCOLORED.
uint take_color(SphereWorld world, uint p) {
  SpherePair pair = pairs[p];
  uint key = key_of(world, pair), a = pair.a - world.bodies.x;
  uint b = pair.b == SPHERE_GROUND ? a : pair.b - world.bodies.x;  // a valid index: compilers may read it anyway
  bool a_moves = moves(pair.a), b_moves = pair.b != SPHERE_GROUND && moves(pair.b);
  if (a_moves && lowest_of(a) != key || b_moves && lowest_of(b) != key) return UNCOLORED;
  uvec2 used = uvec2(0u);
  if (a_moves) used |= uvec2(used_low_of(a), used_high_of(a));
  if (b_moves) used |= uvec2(used_low_of(b), used_high_of(b));
  uint color = lowest_free(used);
  used = color_bit(color);
  if (a_moves) {
    used_low_of(a) |= used.x;
    used_high_of(a) |= used.y;
  }
  if (b_moves) {
    used_low_of(b) |= used.x;
    used_high_of(b) |= used.y;
  }
  pairs[p].color = color;
  return color;
}
