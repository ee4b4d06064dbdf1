#include "solver/sphere/shapes/field.hpp"

#include "solver/sphere/passes/lanes.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes::sphere {

namespace {

/// Corner values around a point of the grid, and where in the cell it lies.
struct Cell {
  float c0, c1, c2, c3, c4, c5, c6, c7;  ///< x fastest, then y, then z
  float u, v, w;
  float outside;  ///< way from the point to the grid (m)
};

/// A field's numbers as plain scalars, which a compiler can keep in registers over a loop.
struct Grid {
  float ox, oy, oz, inverse_cell, cell, padding;
  int nx, ny, nz;
  const float* values;
  explicit Grid(const Field& f)
      : ox(f.origin.x()),
        oy(f.origin.y()),
        oz(f.origin.z()),
        inverse_cell(f.inverse_cell),
        cell(f.cell),
        padding(f.padding),
        nx(f.nx),
        ny(f.ny),
        nz(f.nz),
        values(f.values) {}
};

inline Cell locate(const Grid& f, float px, float py, float pz) {
  const float gx = (px - f.ox) * f.inverse_cell;
  const float gy = (py - f.oy) * f.inverse_cell;
  const float gz = (pz - f.oz) * f.inverse_cell;
  const float x = std::min(std::max(gx, 0.0f), static_cast<float>(f.nx) - 1.001f);
  const float y = std::min(std::max(gy, 0.0f), static_cast<float>(f.ny) - 1.001f);
  const float z = std::min(std::max(gz, 0.0f), static_cast<float>(f.nz) - 1.001f);
  const int i = static_cast<int>(x), j = static_cast<int>(y), k = static_cast<int>(z);
  const int row = f.nx, slice = f.nx * f.ny, at = i + row * j + slice * k;  // a field has fewer than 2^31 nodes
  const float* p = f.values;
  Cell cell;
  cell.c0 = p[at];
  cell.c1 = p[at + 1];
  cell.c2 = p[at + row];
  cell.c3 = p[at + row + 1];
  cell.c4 = p[at + slice];
  cell.c5 = p[at + slice + 1];
  cell.c6 = p[at + slice + row];
  cell.c7 = p[at + slice + row + 1];
  cell.u = x - static_cast<float>(i);
  cell.v = y - static_cast<float>(j);
  cell.w = z - static_cast<float>(k);
  const float dx = gx - x, dy = gy - y, dz = gz - z;
  const float out = dx * dx + dy * dy + dz * dz;
  cell.outside = out > 1e-4f ? std::sqrt(out) * f.cell : 0.0f;
  return cell;
}

inline float mix(float a, float b, float t) {
  return a + (b - a) * t;
}

inline float value(const Cell& c) {
  const float x0 = mix(c.c0, c.c1, c.u), x1 = mix(c.c2, c.c3, c.u);
  const float x2 = mix(c.c4, c.c5, c.u), x3 = mix(c.c6, c.c7, c.u);
  return mix(mix(x0, x1, c.v), mix(x2, x3, c.v), c.w);
}

/// Value on the grid, or a lower bound beyond it.
inline float distance_of(const Grid& f, const Cell& c, float value) {
  const float beyond = std::max(value, c.outside + f.padding);
  return c.outside > 0 ? beyond : value;
}

template <int N>
inline void sample_all(const Field& f, const Carry& carry, const Points<N>& in, Points<N>& out, float* distances) {
  const Mat3f& r = carry.rotation;
  const float r00 = r(0, 0), r01 = r(0, 1), r02 = r(0, 2), r10 = r(1, 0), r11 = r(1, 1), r12 = r(1, 2), r20 = r(2, 0),
              r21 = r(2, 1), r22 = r(2, 2), tx = carry.offset.x(), ty = carry.offset.y(), tz = carry.offset.z();
  for (int i = 0; i < N; ++i) {
    out.x[i] = r00 * in.x[i] + r01 * in.y[i] + r02 * in.z[i] + tx;
    out.y[i] = r10 * in.x[i] + r11 * in.y[i] + r12 * in.z[i] + ty;
    out.z[i] = r20 * in.x[i] + r21 * in.y[i] + r22 * in.z[i] + tz;
  }
  if (f.ball > 0) {
    for (int i = 0; i < N; ++i)
      distances[i] = std::sqrt(out.x[i] * out.x[i] + out.y[i] * out.y[i] + out.z[i] * out.z[i]) - f.ball;
    return;
  }
  const Grid grid(f);
  const float *x = out.x, *y = out.y, *z = out.z;
#pragma GCC ivdep  // distances and values do not overlap
  for (int i = 0; i < N; ++i) {
    const Cell c = locate(grid, x[i], y[i], z[i]);
    distances[i] = distance_of(grid, c, value(c));
  }
}

}  // namespace

float Field::sample(const Vec3f& point) const {
  if (ball > 0) return point.norm() - ball;
  const Grid grid(*this);
  const Cell c = locate(grid, point.x(), point.y(), point.z());
  return distance_of(grid, c, value(c));
}

float Field::sample(const Vec3f& point, Vec3f& gradient) const {
  if (ball > 0) {
    const float distance = point.norm();
    gradient = distance > 0 ? Vec3f(point / distance) : Vec3f(Vec3f::UnitZ());
    return distance - ball;
  }
  const Grid grid(*this);
  const Cell c = locate(grid, point.x(), point.y(), point.z());
  const float x0 = mix(c.c0, c.c1, c.u), x1 = mix(c.c2, c.c3, c.u);
  const float x2 = mix(c.c4, c.c5, c.u), x3 = mix(c.c6, c.c7, c.u);
  const float y0 = mix(x0, x1, c.v), y1 = mix(x2, x3, c.v);
  const float dx0 = mix(c.c1 - c.c0, c.c3 - c.c2, c.v), dx1 = mix(c.c5 - c.c4, c.c7 - c.c6, c.v);
  gradient = Vec3f(mix(dx0, dx1, c.w), mix(x1 - x0, x3 - x2, c.w), y1 - y0);
  const float length = gradient.norm();
  // On the medial axis the slopes of both sides cancel: out is then away from the centre of mass.
  if (length > 1e-3f * cell)  // differences of neighbours: a slope of 1 is one cell
    gradient /= length;
  else
    gradient = point.squaredNorm() > 0 ? Vec3f(point.normalized()) : Vec3f(Vec3f::UnitZ());
  return distance_of(grid, c, mix(y0, y1, c.w));
}

BIN_SCENES_WIDE
void sample(const Field& field, const Carry& carry, const Points<8>& points, Points<8>& carried, float* distances) {
  sample_all(field, carry, points, carried, distances);
}

BIN_SCENES_WIDE
void sample(const Field& field, const Carry& carry, const Points<16>& points, Points<16>& carried, float* distances) {
  sample_all(field, carry, points, carried, distances);
}

}  // namespace bin_scenes::sphere
