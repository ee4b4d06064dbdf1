// What the nodes of a body are tested against: the other body's field, or a plane of the bin. Needs sphere/field.h.

// Distance to the solid beyond a plane, and the direction out of it. A wall ends at the bin's top: it is the corner
// between its inner face and the rim's level, as thick as it takes.
float plane_distance(SpherePlane plane, float top, vec3 p, out vec3 away) {
  float face = dot(plane.plane.xyz, p) - plane.plane.w, above = p.z - top;
  const vec3 up = vec3(0.0, 0.0, 1.0);
  away = plane.plane.xyz;
  if (plane.wall.x == 0u || above <= 0.0 && face >= above) return face;
  away = up;
  if (above <= 0.0 || face <= 0.0) return above;
  float way = sqrt(above * above + face * face);
  away = (above * up + face * plane.plane.xyz) / way;
  return way;
}

struct Solid {
  bool is_plane;
  Field field;
  SpherePlane plane;
  float top;  // of walls
};

// Distance (m, negative inside) and the direction out.
float depth_in(Solid solid, vec3 p, out vec3 away) {
  return solid.is_plane ? plane_distance(solid.plane, solid.top, p, away) : sample_field(solid.field, p, away);
}
