// Normal cones of nodes and edges. Needs the binding Nodes.

const float LEAST_LEFT = 0.1;  // of a unit direction: what leans over more than 84 degrees does not press

// Of the axis at a place: how far normals lean from it (rad).
float spread_of(uint at) { return uintBitsToFloat(nodes[at].cone); }

// Turns a unit direction into the cone; false if less than `least` of it is left there (cosine of the turn). `cone` as
// in SPHERE_AXIS, its vectors counted from `first`. Bounds by cyclic projection.
bool turn_into_cone(uint cone, uint first, inout vec3 direction, float least) {
  uint bounds = cone & 7u, at = first + (cone >> 3);
  if (bounds == 0u) return true;
  if (bounds == SPHERE_AXIS) {
    vec3 axis = nodes[at].place;
    float spread = spread_of(at);
    float along = dot(axis, direction);
    if (along < LEAST_LEFT) return false;
    vec3 across = direction - along * axis;
    float side = length(across);
    if (atan(side, along) <= spread) return true;
    vec3 turned = cos(spread) * axis + sin(spread) / side * across;
    if (dot(turned, direction) < least) return false;
    direction = turned;
    return true;
  }
  vec3 n = direction;
  for (int sweep = 0; sweep < 8; ++sweep) {
    float outside = 0.0;
    for (uint i = 0u; i < bounds; ++i) {
      vec3 bound = nodes[at + i].place;
      float over = dot(n, bound);
      if (over <= 0.0) continue;
      outside = max(outside, over);
      n -= over * bound;
    }
    if (outside < 1e-5) break;
  }
  float left = length(n);
  if (left < least) return false;  // not the cosine of n / left: far outside, n may lie askew yet, and is short
  direction = n / left;
  return true;
}

// Unit direction in the middle of the cone; 0 of a cone of all directions.
vec3 middle_of_cone(uint cone, uint first) {
  uint bounds = cone & 7u, at = first + (cone >> 3);
  if (bounds == 0u) return vec3(0.0);
  if (bounds == SPHERE_AXIS) return nodes[at].place;
  vec3 sum = vec3(0.0);
  for (uint i = 0u; i < bounds; ++i) sum -= nodes[at + i].place;
  float size = length(sum);
  return size > 0.0 ? sum / size : sum;
}
