// The grid in which bodies of a large world find each other: a body lies in the cell of its box's centre, and boxes that
// are no larger than a cell meet only in neighbouring ones. Cells are found by hash (Teschner et al. 2003, "Optimized
// spatial hashing for collision detection of deformable objects"). Needs the binding Large.
uniform float smallest_cell;  // m
uniform uint buckets;         // a power of two

// As large as the largest box that moves, within limits: one fast body must not make the cells of all others large.
float cell_size() { return clamp(uintBitsToFloat(large.extent), smallest_cell, 2.0 * smallest_cell); }

// xyz: its place in the grid; w: 1 if the box is no larger than a cell. Asked once a step: two programs may round apart.
ivec4 cell_of(SphereBox box) {
  float size = cell_size();
  bool fits = 2.0 * max(box.half_size.x, max(box.half_size.y, box.half_size.z)) <= size;
  return ivec4(clamp(floor(box.center.xyz / size), -1e6, 1e6), fits ? 1 : 0);
}
uint bucket_of(ivec3 cell) {
  uvec3 c = uvec3(cell) * uvec3(73856093u, 19349663u, 83492791u);
  return (c.x ^ c.y ^ c.z) & (buckets - 1u);
}
