// The distance field of one part, trilinear on a grid or the closed form of a ball. Needs the bindings Shapes and Fields.
struct Field {
  vec3 origin;
  vec3 most;   // largest grid coordinate looked up
  float cell, inverse_cell, padding, ball;
  uint row, slice, first;
};

Field field_of(uint shape) {
  SphereShape s = shapes[shape];
  return Field(s.origin.xyz, vec3(s.grid.xyz) - 1.001, s.origin.w, s.field.x, s.field.y, s.field.z, s.grid.x,
               s.grid.x * s.grid.y, s.grid.w);
}

// Distance (m, negative inside) and its gradient. Outside the grid: a lower bound, the way to the grid added.
float sample_field(Field f, vec3 point, out vec3 gradient) {
  if (f.ball > 0.0) {
    float way = length(point);
    gradient = way > 0.0 ? point / way : vec3(0.0, 0.0, 1.0);
    return way - f.ball;
  }
  vec3 g = (point - f.origin) * f.inverse_cell;
  vec3 x = clamp(g, vec3(0.0), f.most);  // also of NaN: reads stay inside
  uvec3 i = min(uvec3(x), uvec3(f.most));
  vec3 t = x - vec3(i);
  uint p = f.first + i.x + i.y * f.row + i.z * f.slice;
  vec4 low = vec4(fields[p], fields[p + f.row], fields[p + f.slice], fields[p + f.slice + f.row]);
  uint q = p + 1u;
  vec4 high = vec4(fields[q], fields[q + f.row], fields[q + f.slice], fields[q + f.slice + f.row]);
  vec4 rise = high - low;
  vec4 along_x = low + rise * t.x;
  vec2 along_y = along_x.xz + (along_x.yw - along_x.xz) * t.y;
  vec2 slope_x = rise.xz + (rise.yw - rise.xz) * t.y, slope_y = along_x.yw - along_x.xz;
  gradient = vec3(slope_x.x + (slope_x.y - slope_x.x) * t.z, slope_y.x + (slope_y.y - slope_y.x) * t.z,
                  along_y.y - along_y.x);
  // On the medial axis the slopes of both sides cancel: out is then away from the centre of mass.
  float steep = length(gradient);
  if (steep > 1e-3 * f.cell)
    gradient /= steep;
  else
    gradient = dot(point, point) > 0.0 ? normalize(point) : vec3(0.0, 0.0, 1.0);
  float distance = along_y.x + (along_y.y - along_y.x) * t.z;
  vec3 beyond = g - x;
  float outside2 = dot(beyond, beyond);
  return outside2 > 1e-4 ? max(distance, sqrt(outside2) * f.cell + f.padding) : distance;
}

float sample_field(Field f, vec3 point) {
  vec3 unused;
  return sample_field(f, point, unused);
}

// m: no way within the part is longer.
float span(Field f) { return f.ball > 0.0 ? 2.0 * f.ball : f.cell * length(f.most + 1.001); }

// How far (m) a sample at `point`, where the field is `distance`, is from being outside along a unit direction, having
// been inside; negative if it is not, for as long as `reach`.
float way_out(Field f, vec3 point, vec3 along, float distance, float reach) {
  float least = 0.25 * f.cell, t = 0.0, before = distance;
  bool inside = distance < 0.0;
  while (t < reach) {
    float way = max(abs(before), least);
    t += way;
    float now = sample_field(f, point + t * along);
    if (now >= 0.0 && inside) return t - way * now / (now - before);
    inside = inside || now < 0.0;
    before = now;
  }
  return -1.0;
}
