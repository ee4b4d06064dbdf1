// Colors of manifolds.
const uint UNCOLORED = 0xfffffffeu, NOT_SOLVED = 0xffffffffu;
const uint LAST_COLOR = SPHERE_COLORS - 1u;  // any number of manifolds, solved one by one

// Different for all pairs of a world of up to 65,536 bodies; the finaliser of MurmurHash3 is one to one.
uint hashed_key(SpherePair pair, uint first_body) {
  uint a = pair.a - first_body, b = pair.b == SPHERE_GROUND ? a : pair.b - first_body;
  uint key = a << 16 | b;
  key = (key ^ key >> 16) * 0x85ebca6bu;
  key = (key ^ key >> 13) * 0xc2b2ae35u;
  return key ^ key >> 16;
}

uint lowest_free(uvec2 used) {
  if (used.x != 0xffffffffu) return uint(findLSB(~used.x));
  return used.y != 0xffffffffu ? 32u + uint(findLSB(~used.y)) : LAST_COLOR;
}

uvec2 color_bit(uint color) { return color < 32u ? uvec2(1u << color, 0u) : uvec2(0u, 1u << (color - 32u)); }
