// Packs and unpacks the words of a SphereOrdered (shared/sphere.h): the two bodies of a manifold, its flags, and the
// numbers of its contacts.
uint pack_bodies(uint a, uint b) { return a | b << 16; }
uint first_of_bodies(uint bodies) { return bodies & 0xffffu; }
uint second_of_bodies(uint bodies) { return bodies >> 16; }

// Before rows are assigned, the bits of the flags contain the position of a manifold in its block.
uint lane_of(uint kind) { return kind & 0xffu; }
uint without_lane(uint kind) { return kind & ~0xffu; }
uint pack_kind(uint flags, uint count, uint stride, uint near) { return flags | count << 8 | stride << 12 | near << 24; }
uint count_of(uint kind) { return kind >> 8 & 0xfu; }
uint stride_of(uint kind) { return kind >> 12 & 0x3fu; }
uint near_of(uint kind) { return kind >> 24; }
// The bits of contacts that wait in relaxation: four at bit 4, and four at bit 18.
uint waiting_of(uint kind) { return kind >> 4 & 0xfu | kind >> 14 & 0xf0u; }
uint with_waiting(uint kind, uint waiting) {
  return kind & 0xffc3ff0fu | (waiting & 0xfu) << 4 | (waiting & 0xf0u) << 14;
}
uint with_near(uint kind, uint near) { return kind & 0xffffffu | near << 24; }
uint all_of(uint count) { return (1u << count) - 1u; }

// Indices of the bodies of a manifold among the bodies of all worlds.
struct Members {
  uint a, b;  // b may be SPHERE_GROUND
};

Members bodies_of(SphereWorld world, uint bodies) {
  uint b = second_of_bodies(bodies);
  return Members(world.bodies.x + first_of_bodies(bodies), b == SPHERE_GROUND_BODY ? SPHERE_GROUND : world.bodies.x + b);
}
