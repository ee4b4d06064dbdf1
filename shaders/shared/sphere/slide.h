// Distance to the solids against which nodes are tested, and the movement of nodes along curved faces. The
// includer defines before: field.h, cone.h, Samples, node_at(samples, i), cone_at(samples, i),
// face_spacing_of(samples), Plane, normal_of(plane), offset_of(plane), is_wall(plane), Carry (rotation, offset), and
// Solid: a field, or a plane of a bin whose walls end at `top` (m).

// Returns the distance (m) of p from the solid behind a plane, and the unit direction out of it. A wall ends at the
// height `top` (m): it is the solid below the plane of the rim and behind its inner face, and has no outer face.
INLINE float distance_to_plane(IN(Plane) plane, float top, IN(vec3) p, OUT(vec3) away) {
  vec3 up = vec3(0.0f, 0.0f, 1.0f), normal = normal_of(plane);
  float face = dot(normal, p) - offset_of(plane), above = dot(p, up) - top;
  away = normal;
  if (!is_wall(plane) || (above <= 0.0f && face >= above)) return face;
  away = up;
  if (above <= 0.0f || face <= 0.0f) return above;
  float distance = sqrt(above * above + face * face);
  away = (above * up + face * normal) / distance;
  return distance;
}

// Returns the distance (m, negative inside) of p from a solid, and the unit direction out of the solid.
INLINE float distance_to(IN(Solid) solid, IN(vec3) p, OUT(vec3) away) {
  if (solid.is_plane) return distance_to_plane(solid.plane, solid.top, p, away);
  return sample_field(solid.field, p, away);
}

// Moves a node of a curved face, which represents its surroundings, along its own surface to the deepest point. The
// length of the movement follows from the angle between the normal of the node and the gradient of the depth, and from
// how fast the normals rotate along the surface (cone). The field of the node's own part brings the point back to the
// surface. `touch` is the result for the node itself in the frame of the solid, and is replaced. `carry`: from the
// frame of the node to that of the solid.
INLINE void slide(IN(Samples) samples, IN(Field) own, IN(Carry) carry, uint node, IN(Solid) solid, INOUT(Touch) touch) {
  const float flat_angle = 0.02f;  // rad: at a smaller angle, the node itself is deep enough
  IN(Cone) cone = cone_at(samples, node);
  float face_spacing = face_spacing_of(samples);
  if (bounds_of(cone) != SPHERE_AXIS || own.ball > 0.0f || face_spacing <= 0.0f) return;
  float spread = spread_of(cone);
  if (spread < flat_angle) return;
  float distance_per_angle = 2.0f * face_spacing / spread;
  vec3 start = node_at(samples, node), x = start, normal = axis_of(cone);
  for (int i = 0; i < 6; ++i) {
    vec3 down = -turned_back(carry.rotation, touch.gradient), across = down - dot(down, normal) * normal;
    float angle = length(across);
    if (angle < flat_angle || dot(down, normal) < 0.5f) return;
    vec3 there = x + min(angle * distance_per_angle, face_spacing) / angle * across, normal_there, slope;
    float off = sample_field(own, there, normal_there);
    there -= off * normal_there;
    vec3 carried = carry.rotation * there + carry.offset;
    float deeper = distance_to(solid, carried, slope);
    // The point has passed the deepest point, has left the face, or is at another node.
    if (deeper >= touch.distance || abs(sample_field(own, there)) > 0.1f * own.cell ||
        length(there - start) > face_spacing) {
      distance_per_angle *= 0.5f;
      continue;
    }
    x = there;
    normal = normal_there;
    touch.point = carried;
    touch.gradient = slope;
    touch.distance = deeper;
  }
}
