/// Arithmetic on eight values (lanes) at once, with the vector types of GCC and Clang: +, -, *, comparisons and ?: work
/// lane by lane. Each lane computes what a single float would, so that a result does not depend on its neighbours.
/// There are eight lanes although SSE and NEON registers hold four: a contact waits for the result of the previous one,
/// and a second group of four uses this waiting time.
#pragma once

#include <Eigen/Core>

#include <cstdint>

/// Attribute of a function: the compiler makes one version of it, with all that it calls, for any x86-64 and one for
/// AVX2, and one is selected at load time. Neither fuses multiply and add, so both give the same bits. With sanitizers
/// there is one version: the selection runs before a sanitizer has started, and would crash in it.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define BIN_SCENES_WIDE __attribute__((target_clones("avx2", "default"), flatten))
#else
#define BIN_SCENES_WIDE
#endif

namespace bin_scenes::sphere {

using Lanes = float __attribute__((vector_size(32), aligned(32)));
using LaneMask =
    std::int32_t __attribute__((vector_size(32), aligned(32)));  ///< result of a comparison: -1 = true, 0 = false
constexpr int lane_count = 8;

inline Lanes all_lanes(float x) {
  return Lanes{x, x, x, x, x, x, x, x};
}
inline Lanes min(Lanes a, Lanes b) {
  return a < b ? a : b;
}
inline Lanes max(Lanes a, Lanes b) {
  return a > b ? a : b;
}
inline Lanes select(LaneMask condition, Lanes yes, Lanes no) {
  return condition ? yes : no;
}
/// Returns the square roots, rounded like those of single floats.
inline Lanes sqrt(Lanes a) {
  Lanes root;
  for (int lane = 0; lane < lane_count; ++lane) root[lane] = __builtin_sqrtf(a[lane]);
  return root;
}
inline bool any(LaneMask m) {
  using Pairs = std::int64_t __attribute__((vector_size(32)));
  const Pairs pairs = reinterpret_cast<Pairs>(m);
  return (pairs[0] | pairs[1] | pairs[2] | pairs[3]) != 0;
}

/// Eight vectors with three components.
struct LaneVec {
  Lanes x{}, y{}, z{};

  void set(int lane, const Eigen::Vector3f& v) {
    x[lane] = v.x();
    y[lane] = v.y();
    z[lane] = v.z();
  }
  Eigen::Vector3f at(int lane) const { return {x[lane], y[lane], z[lane]}; }
};

inline LaneVec operator+(const LaneVec& a, const LaneVec& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline LaneVec operator-(const LaneVec& a, const LaneVec& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline LaneVec operator*(Lanes s, const LaneVec& a) {
  return {s * a.x, s * a.y, s * a.z};
}
inline Lanes dot(const LaneVec& a, const LaneVec& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline LaneVec cross(const LaneVec& a, const LaneVec& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
/// Returns the unit vectors; 0 for vectors of length 0.
inline LaneVec unit(const LaneVec& a) {
  const Lanes length = sqrt(dot(a, a));
  return (length > 0.0f ? all_lanes(1) / length : all_lanes(0)) * a;
}

/// Eight symmetric 3 x 3 matrices.
struct LaneSymmetric {
  Lanes xx{}, yy{}, zz{}, xy{}, xz{}, yz{};

  void set(int lane, const Eigen::Matrix3f& m) {
    xx[lane] = m(0, 0);
    yy[lane] = m(1, 1);
    zz[lane] = m(2, 2);
    xy[lane] = m(0, 1);
    xz[lane] = m(0, 2);
    yz[lane] = m(1, 2);
  }
};

inline LaneVec operator*(const LaneSymmetric& m, const LaneVec& v) {
  return {m.xx * v.x + m.xy * v.y + m.xz * v.z, m.xy * v.x + m.yy * v.y + m.yz * v.z,
          m.xz * v.x + m.yz * v.y + m.zz * v.z};
}

/// A vector with three components and a fourth value, in the layout of the data of bodies.
using Quad = float __attribute__((vector_size(16)));

/// Transposes a 4 x 4 matrix: four vectors (x, y, z, w) become all x, all y, all z, all w, and vice versa.
inline void transpose(Quad& a, Quad& b, Quad& c, Quad& d) {
  const Quad ab_low = __builtin_shufflevector(a, b, 0, 4, 1, 5), ab_high = __builtin_shufflevector(a, b, 2, 6, 3, 7);
  const Quad cd_low = __builtin_shufflevector(c, d, 0, 4, 1, 5), cd_high = __builtin_shufflevector(c, d, 2, 6, 3, 7);
  a = __builtin_shufflevector(ab_low, cd_low, 0, 1, 4, 5);
  b = __builtin_shufflevector(ab_low, cd_low, 2, 3, 6, 7);
  c = __builtin_shufflevector(ab_high, cd_high, 0, 1, 4, 5);
  d = __builtin_shufflevector(ab_high, cd_high, 2, 3, 6, 7);
}
inline Lanes join(Quad low, Quad high) {
  return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
}
inline Quad low_half(Lanes a) {
  return __builtin_shufflevector(a, a, 0, 1, 2, 3);
}
inline Quad high_half(Lanes a) {
  return __builtin_shufflevector(a, a, 4, 5, 6, 7);
}

}  // namespace bin_scenes::sphere
