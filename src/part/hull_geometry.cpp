#include "bin_scenes/part/hull_geometry.hpp"

#include <LinearMath/btConvexHullComputer.h>

#include <algorithm>
#include <map>

namespace bin_scenes {
namespace {

/// Extreme points in `count` directions spread evenly by the Fibonacci spiral, and along the axes.
std::vector<Vec3> extreme_points(const std::vector<Vec3>& points, int count) {
  std::vector<std::size_t> chosen;
  const auto choose = [&](const Vec3& direction) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < points.size(); ++i) {
      if (points[i].dot(direction) > points[best].dot(direction)) best = i;
    }
    if (std::find(chosen.begin(), chosen.end(), best) == chosen.end()) chosen.push_back(best);
  };
  for (int axis = 0; axis < 3; ++axis) {
    choose(Vec3::Unit(axis));
    choose(-Vec3::Unit(axis));
  }
  // Several directions share a point: ask more of them than points are wanted.
  const double golden = M_PI * (3 - std::sqrt(5.0));
  const int directions = 4 * count;
  for (int i = 0; i < directions && static_cast<int>(chosen.size()) < count; ++i) {
    const int k = static_cast<int>(static_cast<long long>(i) * 89 % directions);  // spread from the first one on
    const double z = 1 - (2 * k + 1.0) / directions, r = std::sqrt(1 - z * z);
    choose(Vec3(r * std::cos(golden * k), r * std::sin(golden * k), z));
  }
  std::vector<Vec3> extremes;
  for (const std::size_t i : chosen) extremes.push_back(points[i]);
  return extremes;
}

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

}  // namespace

Mesh convex_hull(const std::vector<Vec3>& points, int max_vertices) {
  Mesh hull = full_hull(points);
  if (static_cast<int>(hull.vertices.size()) > max_vertices) {
    hull = full_hull(extreme_points(hull.vertices, std::max(4, max_vertices)));
  }
  if (hull.empty()) return {};
  const double size = hull.bounds().diagonal(), enclosed = volume(hull);
  if (std::abs(enclosed) < 1e-7 * size * size * size) return {};
  if (enclosed < 0) {
    for (Triangle& t : hull.triangles) std::swap(t[1], t[2]);
  }
  return hull;
}

HullPlanes::HullPlanes(const Mesh& hull) : bounds_(hull.bounds()) {
  for (std::size_t t = 0; t < hull.triangles.size(); ++t) {
    const Vec3 area = hull.area_vector(t);
    const double length = area.norm();
    if (!(length > 0)) continue;
    const Vec3 normal = area / length;
    double offset = -std::numeric_limits<double>::infinity();
    for (const std::uint32_t v : hull.triangles[t]) offset = std::max(offset, normal.dot(hull.vertices[v]));
    const bool known = !planes_.empty() && (planes_.back().normal - normal).norm() < 1e-9;
    if (!known) planes_.push_back({normal, offset});
  }
}

double HullPlanes::outside(const Vec3& p) const {
  double most = -std::numeric_limits<double>::infinity();
  for (const Plane& plane : planes_) most = std::max(most, plane.normal.dot(p) - plane.offset);
  return most;
}

bool HullPlanes::covers(const Vec3& p, const Vec3& normal, double tolerance) const {
  bool opposed = false;
  double most = -std::numeric_limits<double>::infinity();
  for (const Plane& plane : planes_) {
    const double outside = plane.normal.dot(p) - plane.offset;
    if (outside > tolerance) return false;
    most = std::max(most, outside);
    opposed = opposed || (outside > -tolerance && plane.normal.dot(normal) < -0.5);
  }
  return most < -tolerance || opposed;
}

}  // namespace bin_scenes
