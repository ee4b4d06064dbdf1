/// The distance field of a part in its body frame, and the two queries of the narrow phase: one point with the
/// gradient, or a group of points with distances only. Nearly all tests are of the second kind, and most of them need
/// nothing more.
#pragma once

#include "solver/sphere/shared_code.hpp"

namespace bin_scenes::sphere {

/// Coordinates of N points, stored by component so that one instruction processes several. N is a multiple of 8.
template <int N>
struct alignas(32) Points {
  float x[N], y[N], z[N];

  void set(int i, const Vec3f& p) {
    x[i] = p.x();
    y[i] = p.y();
    z[i] = p.z();
  }
  Vec3f operator[](int i) const { return {x[i], y[i], z[i]}; }
};

/// The rigid transform of points from the frame of one body to that of another.
struct Carry {
  Mat3f rotation;
  Vec3f offset;
  Vec3f operator()(const Vec3f& p) const { return rotation * p + offset; }
};

/// The distance field of a part: trilinear interpolation on a grid, or the closed form of a ball.
struct Field {
  float ball = 0;  ///< m: radius if the part is a ball, which has no grid; else 0
  Vec3f origin = Vec3f::Zero();
  float cell = 1, inverse_cell = 1, padding = 0;
  int nx = 0, ny = 0, nz = 0;
  const float* values = nullptr;  ///< owned by the PartModel

  /// Returns the distance (m, negative inside) and its gradient. Outside of the grid, the distance is a lower bound.
  float sample(const Vec3f& point, Vec3f& gradient) const;
  float sample(const Vec3f& point) const;
};

inline float sample_field(const Field& field, const Vec3f& point, Vec3f& gradient) {
  return field.sample(point, gradient);
}
inline float sample_field(const Field& field, const Vec3f& point) {
  return field.sample(point);
}
/// Returns an upper bound of the length (m) of all straight lines within the part.
inline float span_of(const Field& f) {
  return f.ball > 0 ? 2 * f.ball : f.cell * Eigen::Vector3i(f.nx, f.ny, f.nz).cast<float>().norm();
}

#include "shared/sphere/field.h"

/// Transforms N points into the field's frame and samples it there, with the same bits as one point after the other.
void sample(const Field& field, const Carry& carry, const Points<8>& points, Points<8>& carried, float* distances);
void sample(const Field& field, const Carry& carry, const Points<16>& points, Points<16>& carried, float* distances);

}  // namespace bin_scenes::sphere
