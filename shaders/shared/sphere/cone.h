// The normal cone of a point on the surface of a part: the directions in which contacts may press on it. The includer
// defines before: Cone, bounds_of(cone), bound_at(cone, i), axis_of(cone), spread_of(cone).
//
// The grid of a distance field rounds edges off, so that the gradient is tilted within one cell of an edge. If two
// parts lie with their edges flush, this gradient would push one part sideways off the other. Such a direction is
// rotated into the cone (touch.h states when).

const float LEAST_LEFT = 0.1f;  // smallest cosine of a rotation into the cone: along a direction that is more than 84
                                // degrees outside the cone, no contact presses
const int CONE_SWEEPS = 8;      // number of cyclic projections on the bounds; two suffice if these are perpendicular

// Rotates a unit direction into the cone. Returns false if the cosine of the rotation would be below `least`.
INLINE bool turn_into_cone(IN(Cone) cone, INOUT(vec3) direction, float least) {
  uint bounds = bounds_of(cone);
  if (bounds == 0u) return true;
  if (bounds == SPHERE_AXIS) {
    vec3 axis = axis_of(cone);
    float spread = spread_of(cone), along = dot(axis, direction);
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
  for (int sweep = 0; sweep < CONE_SWEEPS; ++sweep) {
    float outside = 0.0f;
    for (uint i = 0u; i < bounds; ++i) {
      IN(vec3) bound = bound_at(cone, i);
      float over = dot(n, bound);
      if (over <= 0.0f) continue;
      outside = max(outside, over);
      n -= over * bound;
    }
    if (outside < 1e-5f) break;
  }
  float left = length(n);
  if (left < least) return false;  // far outside the cone, n has become too short for a direction
  direction = n / left;
  return true;
}

// Returns the unit direction of the axis of the cone; 0 for a cone of all directions.
INLINE vec3 axis_direction(IN(Cone) cone) {
  uint bounds = bounds_of(cone);
  if (bounds == SPHERE_AXIS) return axis_of(cone);
  vec3 sum = vec3(0.0f, 0.0f, 0.0f);
  for (uint i = 0u; i < bounds; ++i) sum -= bound_at(cone, i);
  return unit(sum);
}
