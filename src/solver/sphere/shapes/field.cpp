#include "solver/sphere/shapes/field.hpp"

#include "solver/sphere/passes/lanes.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes::sphere {

namespace {

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
    distances[i] = bounded(c, value_in(c), grid.padding);
  }
}

}  // namespace

float Field::sample(const Vec3f& point) const {
  if (ball > 0) return point.norm() - ball;
  const Grid grid(*this);
  const Cell c = locate(grid, point.x(), point.y(), point.z());
  return bounded(c, value_in(c), padding);
}

float Field::sample(const Vec3f& point, Vec3f& gradient) const {
  if (ball > 0) return distance_to_ball(ball, point, gradient);
  const Grid grid(*this);
  return distance_in(locate(grid, point.x(), point.y(), point.z()), cell, padding, point, gradient);
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
