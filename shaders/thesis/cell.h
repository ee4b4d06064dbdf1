// Returns the grid cell of a point; points outside get a cell at the border. Touching spheres are at most 1 cell apart.
uvec3 cell_of(ThesisWorld world, vec3 p) {
  vec3 last = vec3(world.grid.xyz - 1u);
  vec3 cell = clamp(floor((p - world.origin.xyz) * world.origin.w), vec3(0.0), last);
  return min(uvec3(cell), world.grid.xyz - 1u);  // limited again, for positions that are not finite
}
uint cell_index(ThesisWorld world, uvec3 cell) {
  return world.grid.w + (cell.z * world.grid.y + cell.y) * world.grid.x + cell.x;
}
