/// Determines which pixel centres a triangle covers. It is the innermost part of the triangle walk
/// (raster/projection.hpp), which decides by depth what is visible.
#pragma once

#include "bin_scenes/core/types.hpp"

#include <algorithm>

namespace bin_scenes {

/// A corner of a triangle in the image.
struct ImageCorner {
  double u, v;  ///< pixels, column and row
  double near;  ///< 1 / depth (1/m)
};

/// Return x rounded down, or up, to an integer, without a library call.
inline int down(double x) {
  const int whole = static_cast<int>(x);
  return whole - (whole > x ? 1 : 0);
}
inline int up(double x) {
  const int whole = static_cast<int>(x);
  return whole + (whole < x ? 1 : 0);
}

/// Tolerance (pixels): a pixel centre on the common edge of two triangles counts as covered by both.
constexpr double on_edge = 1e-9;

/// Calls span(row, first, last) for each row from `top` to `bottom`, with the first and last column whose pixel centres
/// the triangle covers, edges included.
template <class Span>
void for_spans(const ImageCorner* const (&corner)[3], int top, int bottom, int width, const Span& span) {
  const auto [low, high] = std::minmax({corner[0]->v, corner[1]->v, corner[2]->v});
  const auto [left, right] = std::minmax({corner[0]->u, corner[1]->u, corner[2]->u});
  if (right < 0.0 || left > width - 1.0 || high < top - on_edge || low > bottom + on_edge) return;
  const int last_row = down(std::min(high + on_edge, static_cast<double>(bottom)));
  for (int row = up(std::max(low - on_edge, static_cast<double>(top))); row <= last_row; ++row) {
    double first = right, last = left;
    for (int k = 0; k < 3; ++k) {
      const ImageCorner &a = *corner[k], &b = *corner[k == 2 ? 0 : k + 1];
      const double below = std::min(a.v, b.v), above = std::max(a.v, b.v);
      if (row < below - on_edge || row > above + on_edge) continue;
      const bool along = above - below <= on_edge;  // the edge is parallel to the row
      const double share = along ? 0.0 : std::clamp((row - a.v) / (b.v - a.v), 0.0, 1.0);
      const double at = a.u + share * (b.u - a.u), other = along ? b.u : at;
      first = std::min(first, std::min(at, other));
      last = std::max(last, std::max(at, other));
    }
    const int from = up(std::max(first - on_edge, 0.0)), to = down(std::min(last + on_edge, width - 1.0));
    if (from <= to) span(row, from, to);
  }
}

}  // namespace bin_scenes
