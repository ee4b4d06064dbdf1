// The positions of the lists of pairs of a world in their buffers. Each world has two lists, one of this step and one
// of the last step, which alternate. Needs the binding Ranges.

// Returns the index of the first pair of a world's list; page: 0 or 1, which of the two lists.
uint list_of(SphereWorld world, uint page) { return 2u * world.pairs.x + page * world.pairs.y; }
uvec2 range_of(uint body, uint page) { return page == 0u ? ranges[body].xy : ranges[body].zw; }
void set_range(uint body, uint page, uvec2 range) {
  if (page == 0u)
    ranges[body].xy = range;
  else
    ranges[body].zw = range;
}
