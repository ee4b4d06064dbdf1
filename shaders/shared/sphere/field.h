// The distance field of a part: trilinear interpolation on a grid, or the closed form of a ball. Whoever includes
// this file defines the struct Field (cell, padding, ball) before it. After it, they define cell_at(), which reads the
// grid, and the functions sample_field(field, point) and sample_field(field, point, gradient), which call cell_at().

// The cell of the grid that contains a point: values at its corners (m; x fastest, then y, then z), the position of the
// point in the cell (0 to 1), and the distance (m) from the grid if the point is outside it.
struct Cell {
  float c0, c1, c2, c3, c4, c5, c6, c7;
  float u, v, w;
  float outside;
};

INLINE float between(float a, float b, float t) {
  return a + (b - a) * t;
}

INLINE float value_in(IN(Cell) c) {
  float x0 = between(c.c0, c.c1, c.u), x1 = between(c.c2, c.c3, c.u);
  float x2 = between(c.c4, c.c5, c.u), x3 = between(c.c6, c.c7, c.u);
  return between(between(x0, x1, c.v), between(x2, x3, c.v), c.w);
}

// Returns `value` (m), or outside the grid a lower bound of the distance (m): at least padding + distance to the grid.
INLINE float bounded(IN(Cell) c, float value, float padding) {
  float beyond = max(value, c.outside + padding);
  return c.outside > 0.0f ? beyond : value;
}

// Returns the distance (m, negative inside) at a point in cell c; `gradient`: unit direction in which it grows.
INLINE float distance_in(IN(Cell) c, float cell, float padding, IN(vec3) point, OUT(vec3) gradient) {
  float x0 = between(c.c0, c.c1, c.u), x1 = between(c.c2, c.c3, c.u);
  float x2 = between(c.c4, c.c5, c.u), x3 = between(c.c6, c.c7, c.u);
  float y0 = between(x0, x1, c.v), y1 = between(x2, x3, c.v);
  float dx0 = between(c.c1 - c.c0, c.c3 - c.c2, c.v), dx1 = between(c.c5 - c.c4, c.c7 - c.c6, c.v);
  gradient = vec3(between(dx0, dx1, c.w), between(x1 - x0, x3 - x2, c.w), y1 - y0);
  float steep = length(gradient), from_center = length(point);
  // On the medial axis, the slopes of both sides cancel. The direction is then away from the centre of mass.
  if (steep > 1e-3f * cell)  // the gradient is not normalised yet: where the slope is 1, its length is one cell
    gradient /= steep;
  else if (from_center > 0.0f)
    gradient = point / from_center;
  else
    gradient = vec3(0.0f, 0.0f, 1.0f);
  return bounded(c, between(y0, y1, c.w), padding);
}

INLINE float distance_to_ball(float radius, IN(vec3) point, OUT(vec3) gradient) {
  float from_center = length(point);
  gradient = vec3(0.0f, 0.0f, 1.0f);
  if (from_center > 0.0f) gradient = point / from_center;
  return from_center - radius;
}
