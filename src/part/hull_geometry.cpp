#include "bin_scenes/part/hull_geometry.hpp"

#include "bin_scenes/core/assertion.hpp"

#include <LinearMath/btConvexHullComputer.h>

#include <algorithm>
#include <limits>

namespace bin_scenes {
namespace {

constexpr double most_tests = 2e8;  ///< of points against planes, half a second: beyond, extreme_points() takes all

Mesh full_hull(const std::vector<Vec3>& points) {
  btConvexHullComputer computer;
  if (points.size() < 4) return {};
  computer.compute(points[0].data(), sizeof(Vec3), static_cast<int>(points.size()), 0, 0);
  Mesh hull;
  // The computer rounds to a grid of 1/10000 of the extent; its vertices are taken from the input instead.
  for (int i = 0; i < computer.vertices.size(); ++i) {
    hull.vertices.push_back(points[computer.original_vertex_index[i]]);
  }
  for (int f = 0; f < computer.faces.size(); ++f) {
    const btConvexHullComputer::Edge* first = &computer.edges[computer.faces[f]];
    const auto corner = static_cast<std::uint32_t>(first->getSourceVertex());
    for (const auto* edge = first->getNextEdgeOfFace(); static_cast<std::uint32_t>(edge->getTargetVertex()) != corner;
         edge = edge->getNextEdgeOfFace()) {
      hull.triangles.push_back({corner, static_cast<std::uint32_t>(edge->getSourceVertex()),
                                static_cast<std::uint32_t>(edge->getTargetVertex())});
    }
  }
  return hull;
}

double volume(const Mesh& hull) {
  double six = 0;
  for (std::size_t t = 0; t < hull.triangles.size(); ++t) {
    six += hull.area_vector(t).dot(hull.vertices[hull.triangles[t][0]] - hull.vertices[0]);
  }
  return six / 6;
}

/// The hull of some of a hull's vertices: the extreme ones along axes and diagonals, then again and again the one that
/// lies furthest outside of the hull so far.
Mesh reduced(const Mesh& hull, int max_vertices) {
  std::vector<char> chosen(hull.vertices.size(), 0);
  std::vector<Vec3> points;
  const auto choose = [&](std::size_t v) {
    if (!chosen[v] && static_cast<int>(points.size()) < max_vertices) points.push_back(hull.vertices[v]);
    chosen[v] = 1;
  };
  const auto extreme = [&](const Vec3& direction) {
    std::size_t best = 0;
    for (std::size_t v = 1; v < hull.vertices.size(); ++v) {
      if (hull.vertices[v].dot(direction) > hull.vertices[best].dot(direction)) best = v;
    }
    return best;
  };
  for (int axis = 0; axis < 3; ++axis) {
    choose(extreme(Vec3::Unit(axis)));
    choose(extreme(-Vec3::Unit(axis)));
  }
  for (int i = 0; i < 8; ++i) choose(extreme({i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0}));
  Mesh smaller = full_hull(points);
  while (static_cast<int>(points.size()) < max_vertices) {
    const HullPlanes planes(smaller);
    std::size_t furthest = 0;
    double most = 0;
    for (std::size_t v = 0; v < hull.vertices.size(); ++v) {
      const double outside = chosen[v] ? 0.0 : planes.outside(hull.vertices[v]);
      if (outside > most) most = outside, furthest = v;
    }
    if (!(most > 0)) break;
    choose(furthest);
    smaller = full_hull(points);
  }
  return smaller;
}

}  // namespace

Mesh convex_hull(const std::vector<Vec3>& points, int max_vertices) {
  Mesh hull = full_hull(points);
  if (static_cast<int>(hull.vertices.size()) > max_vertices) {
    hull = reduced(hull, max_vertices);
  }
  if (hull.empty()) return {};
  const double size = hull.bounds().diagonal(), enclosed = volume(hull);
  if (std::abs(enclosed) < 1e-7 * size * size * size) return {};
  if (enclosed < 0) {
    for (Triangle& t : hull.triangles) std::swap(t[1], t[2]);
  }
  BIN_SCENES_ASSERT(indices_in_range(hull) && volume(hull) > 0.0);
  return hull;
}

std::vector<Vec3> extreme_points(const std::vector<Vec3>& points) {
  const Mesh hull = convex_hull(points, std::numeric_limits<int>::max());
  const HullPlanes planes(hull);
  if (hull.empty() || static_cast<double>(planes.count()) * static_cast<double>(points.size()) > most_tests)
    return points;
  // What lies outside of the hull, because its computer rounds, is not left out.
  const double slack = 1e-9 * hull.bounds().diagonal();
  std::vector<Vec3> extreme = hull.vertices;
  for (const Vec3& x : points)
    if (planes.outside_by_more(x, slack)) extreme.push_back(x);
  BIN_SCENES_ASSERT(extreme.size() >= 4);
  return extreme;
}

HullPlanes::HullPlanes(const Mesh& hull) : bounds_(hull.bounds()) {
  for (std::size_t t = 0; t < hull.triangles.size(); ++t) {
    const Vec3 area = hull.area_vector(t);
    const double length = area.norm();
    if (!(length > 0)) continue;
    const Vec3 normal = area / length;
    if (!planes_.empty() && (planes_.back().normal - normal).norm() < 1e-9) continue;
    // Over all vertices, because the normal of a sliver may point anywhere: its plane then touches the hull elsewhere.
    double offset = -std::numeric_limits<double>::infinity();
    for (const Vec3& v : hull.vertices) offset = std::max(offset, normal.dot(v));
    BIN_SCENES_ASSERT(is_unit(normal) && std::isfinite(offset));
    planes_.push_back({normal, offset});
  }
}

double HullPlanes::outside(const Vec3& p) const {
  double most = -std::numeric_limits<double>::infinity();
  for (const Plane& plane : planes_) most = std::max(most, plane.above(p));
  return most;
}

bool HullPlanes::outside_by_more(const Vec3& p, double limit) const {
  const auto beyond = [&](const Plane& plane) { return plane.above(p) > limit; };
  return std::any_of(planes_.begin(), planes_.end(), beyond);
}

double distance_to_union(const std::vector<HullPlanes>& hulls, const Vec3& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const HullPlanes& hull : hulls) {
    if (hull.to_box(p) < least) least = std::min(least, hull.outside(p));
  }
  return std::max(least, 0.0);
}

}  // namespace bin_scenes
