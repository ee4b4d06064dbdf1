// Determines whether the oriented bounding boxes of two bodies intersect, by the separating-axis test. Needs the
// bindings Bodies, States, Shapes, and sphere/body.h.

struct Box {         // an upright (axis-aligned) box
  vec4 center;     // m; w: margin (m)
  vec4 half_size;  // half extents with margin (m), negative if absent; w: 0 = not moved, 1 = moves, 2 = near ground
};

// Returns whether the oriented boxes are farther apart than `margin` (m) along one of their six face normals.
bool oriented_boxes_apart(uint a, uint b, float margin) {
  mat3 ra = rotation_of(states[a].orientation), rb = rotation_of(states[b].orientation);
  vec3 ca = shapes[bodies[a].ids.x].box_center.xyz, ha = shapes[bodies[a].ids.x].box_half.xyz;
  vec3 cb = shapes[bodies[b].ids.x].box_center.xyz, hb = shapes[bodies[b].ids.x].box_half.xyz;
  vec3 d = (states[b].position.xyz + rb * cb) - (states[a].position.xyz + ra * ca);
  mat3 size = magnitudes(transpose(ra) * rb);
  vec3 gap_a = abs(d * ra) - ha - size * hb, gap_b = abs(d * rb) - hb - ha * size;
  return any(greaterThan(max(gap_a, gap_b), vec3(margin)));
}

// Returns whether two upright boxes intersect; false if neither body moves.
bool upright_boxes_meet(Box a, Box b) {
  if (any(greaterThan(abs(a.center.xyz - b.center.xyz), a.half_size.xyz + b.half_size.xyz))) return false;
  return a.half_size.w + b.half_size.w > 0.0;
}
