// The distance field of one part, trilinear on a grid or the closed form of a ball. Needs the binding Fields.
vec3 field_origin;
vec3 field_most;  // largest grid coordinate looked up
float field_cell, field_inverse_cell, field_padding, field_ball;
uint field_row, field_slice, field_first;

void use_field(uint shape) {
  field_origin = shapes[shape].origin.xyz;
  field_cell = shapes[shape].origin.w;
  field_inverse_cell = shapes[shape].field.x;
  field_padding = shapes[shape].field.y;
  field_ball = shapes[shape].field.z;
  uvec4 grid = shapes[shape].grid;
  field_most = vec3(grid.xyz) - 1.001;
  field_row = grid.x;
  field_slice = grid.x * grid.y;
  field_first = grid.w;
}

// Distance (m, negative inside) and its gradient. Outside the grid: a lower bound, the way to the grid added.
float sample_field(vec3 point, out vec3 gradient) {
  if (field_ball > 0.0) {
    float way = length(point);
    gradient = way > 0.0 ? point / way : vec3(0.0, 0.0, 1.0);
    return way - field_ball;
  }
  vec3 g = (point - field_origin) * field_inverse_cell;
  vec3 x = clamp(g, vec3(0.0), field_most);  // also of NaN: reads stay inside
  uvec3 i = min(uvec3(x), uvec3(field_most));
  vec3 t = x - vec3(i);
  uint p = field_first + i.x + i.y * field_row + i.z * field_slice;
  vec4 low = vec4(fields[p], fields[p + field_row], fields[p + field_slice], fields[p + field_slice + field_row]);
  uint q = p + 1u;
  vec4 high = vec4(fields[q], fields[q + field_row], fields[q + field_slice], fields[q + field_slice + field_row]);
  vec4 rise = high - low;
  vec4 along_x = low + rise * t.x;
  vec2 along_y = along_x.xz + (along_x.yw - along_x.xz) * t.y;
  vec2 slope_x = rise.xz + (rise.yw - rise.xz) * t.y, slope_y = along_x.yw - along_x.xz;
  gradient = vec3(slope_x.x + (slope_x.y - slope_x.x) * t.z, slope_y.x + (slope_y.y - slope_y.x) * t.z,
                  along_y.y - along_y.x);
  // On the medial axis the slopes of both sides cancel: out is then away from the centre of mass.
  float steep = length(gradient);
  if (steep > 1e-3 * field_cell)
    gradient /= steep;
  else
    gradient = dot(point, point) > 0.0 ? normalize(point) : vec3(0.0, 0.0, 1.0);
  float distance = along_y.x + (along_y.y - along_y.x) * t.z;
  vec3 beyond = g - x;
  float outside2 = dot(beyond, beyond);
  return outside2 > 1e-4 ? max(distance, sqrt(outside2) * field_cell + field_padding) : distance;
}

float sample_field(vec3 point) {
  vec3 unused;
  return sample_field(point, unused);
}
