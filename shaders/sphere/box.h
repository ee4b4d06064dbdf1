// Computes the upright (axis-aligned) box of a body, enlarged by the distance that the surface may move in a step
// (reach(), sphere/pair.h), and its inverse inertia. Needs the bindings Settings, Bodies, States, Shapes, Planes,
// sphere/body.h, sphere/pair.h and sphere/oriented_box.h.

SphereTensor tensor_of(uint body) {
  mat3 r = rotation_of(states[body].orientation);
  uint shape = bodies[body].ids.x;
  mat3 t = r * symmetric(shapes[shape].inverse_inertia, shapes[shape].inverse_inertia_mixed) * transpose(r);
  t *= bodies[body].material.x;
  return SphereTensor(vec4(t[0][0], t[1][1], t[2][2], 0.0), vec4(t[0][1], t[0][2], t[1][2], 0.0),
                      states[body].orientation, states[body].velocity, states[body].spin);
}

Box box_of(SphereWorld world, uint body) {
  if (!present(body)) return Box(vec4(0.0), vec4(-1e30, -1e30, -1e30, 0.0));
  mat3 r = rotation_of(states[body].orientation);
  vec4 center = shapes[bodies[body].ids.x].box_center, half_size = shapes[bodies[body].ids.x].box_half;
  float margin = reach(world, body, center.w, half_size.w);
  vec3 mid = states[body].position.xyz + r * center.xyz;
  vec3 extent = magnitudes(r) * half_size.xyz + margin;
  Box box = Box(vec4(mid, margin), vec4(extent, 0.0));
  if (!moves(body)) return box;
  box.half_size.w = 1.0;
  for (uint k = 0u; k < world.pairs.w; ++k) {
    vec4 plane = planes[world.pairs.z + k].plane;
    if (dot(plane.xyz, mid) - dot(abs(plane.xyz), extent) < plane.w) box.half_size.w = 2.0;
  }
  return box;
}
