// The distance field of one part. Needs the bindings Shapes and Fields.
#include "shared/language.h"

struct Field {
  vec3 origin;
  vec3 most;   // largest grid coordinates that are read, in cells
  float cell, inverse_cell, padding, ball;
  uint row, slice, first;
};

Field field_of(uint shape) {
  SphereShape s = shapes[shape];
  return Field(s.origin.xyz, vec3(s.grid.xyz) - 1.001, s.origin.w, s.field.x, s.field.y, s.field.z, s.grid.x,
               s.grid.x * s.grid.y, s.grid.w);
}

// Returns an upper bound (m) of the length of a straight line within the part.
float span_of(Field f) { return f.ball > 0.0 ? 2.0 * f.ball : f.cell * length(f.most + 1.001); }

#include "shared/sphere/field.h"

Cell cell_at(Field f, vec3 point) {
  vec3 g = (point - f.origin) * f.inverse_cell;
  vec3 x = clamp(g, vec3(0.0), f.most);  // limits NaN as well, so that no read is outside the grid
  uvec3 i = min(uvec3(x), uvec3(f.most));
  vec3 t = x - vec3(i), beyond = g - x;
  uint at = f.first + i.x + i.y * f.row + i.z * f.slice;
  vec2 p = fields[at], q = fields[at + 1u], r = fields[at + f.row], s = fields[at + f.row + 1u];
  float outside2 = dot(beyond, beyond);
  return Cell(p.x, q.x, r.x, s.x, p.y, q.y, r.y, s.y,
              t.x, t.y, t.z, outside2 > 1e-4 ? sqrt(outside2) * f.cell : 0.0);
}

float sample_field(Field f, vec3 point, out vec3 gradient) {
  if (f.ball > 0.0) return distance_to_ball(f.ball, point, gradient);
  return distance_in(cell_at(f, point), f.cell, f.padding, point, gradient);
}

float sample_field(Field f, vec3 point) {
  if (f.ball > 0.0) return length(point) - f.ball;
  Cell c = cell_at(f, point);
  return bounded(c, value_in(c), f.padding);
}
