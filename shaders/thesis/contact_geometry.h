// Computes the contact of a sphere with another sphere, or with a node of a sheet. A sheet is a flat surface that is
// covered by a lattice of nodes; only the nodes near the sphere are evaluated.

float sheet_height(ThesisSheet sheet, vec4 center) { return dot(center.xyz - sheet.origin.xyz, sheet.normal.xyz); }

vec2 sheet_position(ThesisSheet sheet, vec4 center) {
  vec3 p = center.xyz - sheet.origin.xyz;
  return vec2(dot(p, sheet.u.xyz), dot(p, sheet.v.xyz));
}

bool sheet_in_reach(ThesisSheet sheet, vec4 center) {
  float height = sheet_height(sheet, center);
  return height < center.w + sheet.origin.w && height > -sheet.surface.z;
}

// Returns whether a sphere is so deep in a sheet that nodes would push it sideways or out through the back. It is then
// pushed along the normal of the sheet, by the nearest node only. A stored layer of spheres would let it pass.
bool sheet_deep(ThesisSheet sheet, vec4 center) {
  return sheet_height(sheet, center) < 0.5 * (center.w + sheet.origin.w);
}

// Returns the position (m, along u and v) of the node that is du and dv steps from the node nearest to the sphere.
vec2 node_position(ThesisSheet sheet, vec4 center, int du, int dv) {
  return (round(sheet_position(sheet, center) / sheet.normal.w) + vec2(du, dv)) * sheet.normal.w;
}

bool sheet_has_node(ThesisSheet sheet, vec4 center, int du, int dv) {
  vec2 node = abs(node_position(sheet, center, du, dv));
  return node.x <= sheet.u.w && node.y <= sheet.v.w;
}

vec3 node_center(ThesisSheet sheet, vec4 center, int du, int dv) {
  vec2 node = node_position(sheet, center, du, dv);
  return sheet.origin.xyz + node.x * sheet.u.xyz + node.y * sheet.v.xyz;
}

float node_depth(ThesisSheet sheet, vec4 center, int du, int dv) {
  float height = sheet_deep(sheet, center) ? sheet_height(sheet, center)
                                        : distance(center.xyz, node_center(sheet, center, du, dv));
  return center.w + sheet.origin.w - height;
}

// Packs the index of a sheet in its world and the steps from the nearest node; the code is the same in every batch.
uint node_code(uint sheet, int du, int dv) { return THESIS_NODE | sheet << 16 | uint(du + 128) << 8 | uint(dv + 128); }

// Returns the unit direction of the push on this sphere: the line of centres, or the normal of the face on which one
// sphere is; if both are on faces, the mean of both normals. For the other sphere the result is exactly opposite. A
// normal that is more than 60 degrees from the line belongs to another side of the part and is not used.
vec3 contact_normal(vec3 line, vec4 own, vec4 other) {
  if (settings.modified_normals == 0u) return line;
  vec3 n = other.w * other.xyz - own.w * own.xyz;
  float size = length(n);
  if (size < 0.5) return line;
  n /= size;
  return dot(n, line) >= 0.5 ? n : line;
}

vec4 face_normal(uint sphere) {
  vec4 local = shapes[spheres[sphere].shape].normal;
  return vec4(rotate(states[spheres[sphere].body].orientation, local.xyz), local.w);
}

vec3 velocity_at(uint body, vec3 point) {
  return states[body].velocity.xyz + cross(states[body].spin.xyz, point - states[body].position.xyz);
}

// Returns the speed (m/s) at which the two bodies must separate: the larger of the rebound and the bias velocity that
// removes overlap (eq 2.29). `left`: depth of overlap (m) that is not removed.
// Guendelman et al. 2003: bodies collide with their velocities before the gravity of this step, which acts afterwards;
// a contact slower than the threshold does not bounce. If gravity were part of the rebound, it would add energy.
float separation_speed(ThesisContact contact, uint body, float left, float restitution) {
  vec3 point = states[body].position.xyz + contact.arm.xyz;
  vec3 fall = settings.time_step * worlds[bodies[body].range.z].gravity.xyz;
  vec3 v = velocity_at(body, point);
  if ((contact.other.y & THESIS_NODE) == 0u) {
    v -= velocity_at(contact.other.y, point);
    if (bodies[contact.other.y].inverse_inertia.w > 0.0) fall = vec3(0.0);  // gravity accelerates both bodies equally
  }
  float approach = -dot(contact.normal.xyz, v - fall);
  bool rests = approach <= worlds[bodies[body].range.z].gravity.w;
  float bounce = rests ? 0.0 : restitution * approach + dot(contact.normal.xyz, fall);
  return max(bounce, settings.bias * max(0.0, contact.normal.w - left));
}

ThesisContact contact_with(uint other, uint sphere, uint body, ThesisWorld world) {
  vec4 center = centers[sphere];
  vec3 line;
  vec4 other_center, other_face;
  vec2 surface;
  float depth;
  uint key;
  bool deep = false;
  if ((other & THESIS_NODE) != 0u) {
    uint k = (other >> 16) & 0x7fffu;
    ThesisSheet sheet = sheets[world.sheets.x + k];
    int du = int((other >> 8) & 0xffu) - 128, dv = int(other & 0xffu) - 128;
    other_center = vec4(node_center(sheet, center, du, dv), sheet.origin.w);
    other_face = vec4(sheet.normal.xyz, 1.0);
    surface = sheet.surface.xy;
    depth = node_depth(sheet, center, du, dv);
    deep = sheet_deep(sheet, center);
    key = THESIS_NODE | k;
  } else {
    other_center = centers[other];
    other_face = settings.modified_normals != 0u ? face_normal(other) : vec4(0.0);
    key = spheres[other].body;
    surface = bodies[key].surface.xy;
    depth = center.w + other_center.w - distance(center.xyz, other_center.xyz);
  }

  vec3 apart = center.xyz - other_center.xyz;
  float size = length(apart);
  // If the centres coincide, any direction is valid that is opposite for the two spheres.
  line = size > 0.0 ? apart / size : vec3(0.0, 0.0, sphere > other ? 1.0 : -1.0);
  vec4 own_face = settings.modified_normals != 0u ? face_normal(sphere) : vec4(0.0);
  vec3 n = deep ? other_face.xyz : contact_normal(line, own_face, other_face);

  // The contact point is in the middle of the overlap on the line of centres; it is the same for both spheres.
  vec3 point = center.xyz - line * (center.w - 0.5 * depth);
  if (deep) point = center.xyz - n * center.w;
  ThesisContact contact;
  contact.normal = vec4(n, depth);
  contact.arm = vec4(point - states[body].position.xyz, sqrt(bodies[body].surface.x * surface.x));
  contact.other = uvec4(other, key, 1u, 0u);
  contact.impulse = vec4(0.0);
  float left = settings.slop * min(center.w, other_center.w);
  contact.total = vec4(0.0, 0.0, 0.0, separation_speed(contact, body, left, max(bodies[body].surface.y, surface.y)));
  return contact;
}
