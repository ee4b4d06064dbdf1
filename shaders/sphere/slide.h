// Nodes of curved faces. Needs sphere/field.h, sphere/solid.h, sphere/cone.h and the binding Nodes.

// A node of a curved face stands for its surroundings: slides it along its own surface to where it lies deepest. The way
// follows from the angle between the node's normal and the gradient of the depth, and from how fast the normals turn
// (cone); the part's own field brings the point back to the surface. `point`, `gradient` and `distance` are the node's
// own in the frame of the solid, and are replaced. `rotation`, `offset`: from the node's frame to the solid's.
void slide(SphereSamples samples, Field own, mat3 rotation, vec3 offset, uint node, Solid solid, inout vec3 point,
           inout vec3 gradient, inout float distance) {
  const float flat_angle = 0.02;  // rad: below it the node itself is deep enough
  vec3 start = nodes[samples.nodes.x + node].place;
  uint cone = nodes[samples.nodes.x + node].cone;
  if ((cone & 7u) != SPHERE_AXIS || own.ball > 0.0) return;
  uint axis = samples.nodes.x + (cone >> 3);
  float spread = spread_of(axis);
  if (spread < flat_angle) return;
  float face_spacing = samples.size.z, way_per_angle = 2.0 * face_spacing / spread;
  vec3 x = start, normal = nodes[axis].place;
  for (int i = 0; i < 6; ++i) {
    vec3 down = -(gradient * rotation), across = down - dot(down, normal) * normal;
    float angle = length(across);
    if (angle < flat_angle || dot(down, normal) < 0.5) return;
    vec3 there = x + min(angle * way_per_angle, face_spacing) / angle * across, normal_there, slope;
    float off = sample_field(own, there, normal_there);
    there -= off * normal_there;
    vec3 carried = rotation * there + offset;
    float deeper = depth_in(solid, carried, slope);
    // Past the deepest point, over the rim of the face, or where another node stands.
    if (deeper >= distance || abs(sample_field(own, there)) > 0.1 * own.cell ||
        length(there - start) > face_spacing) {
      way_per_angle *= 0.5;
      continue;
    }
    x = there;
    normal = normal_there;
    point = carried;
    gradient = slope;
    distance = deeper;
  }
}
