/// Finds round holes by the concave edges of their walls, and cuts what hulls have inside them off by planes that touch
/// their cylinders.
#include "round_holes.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/part/hull_geometry.hpp"
#include "plane_cuts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>

namespace bin_scenes {
namespace {

constexpr double least_turn = 1e-3;        // rad: least turn between two facets of a wall
constexpr double least_cosine = 1 - 1e-6;  // of the angle between lines that count as parallel
constexpr double round = 2e-3;  // of the radius: by how much edges may be nearer to the axis or farther from it
constexpr double widest = 1.1;  // rad: a facet of a hole with six sides covers 1.047
constexpr double widest_sector = M_PI / 4;  // of a hull beside a hole
constexpr double tolerance = 1e-4;          // of the radius: what hulls may keep inside
constexpr int all_corners = std::numeric_limits<int>::max();

/// A concave edge of a wall.
struct WallEdge {
  Vec3 start, end, along, inward;  // inward: half way between the normals of its facets
  Vec3 center() const { return 0.5 * (start + end); }
};

std::vector<WallEdge> wall_edges(const Mesh& mesh) {
  std::vector<std::tuple<std::uint32_t, std::uint32_t, std::size_t>>
      halves;  // ends of an edge, lower one first; triangle
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]);
      halves.emplace_back(low, high, t);
    }
  std::sort(halves.begin(), halves.end());
  std::vector<WallEdge> edges;
  for (std::size_t i = 0; i + 1 < halves.size(); ++i) {
    const auto [low, high, one] = halves[i];
    const auto [other_low, other_high, other] = halves[i + 1];
    if (low != other_low || high != other_high) continue;
    const Vec3 m = mesh.area_vector(one).normalized(), n = mesh.area_vector(other).normalized();
    const Vec3 &a = mesh.vertices[low], &b = mesh.vertices[high];
    Vec3 far = -a - b;  // the corner of the other triangle that is not on the edge
    for (const std::uint32_t v : mesh.triangles[other]) far += mesh.vertices[v];
    if (!(m.cross(n).norm() > least_turn) || !(m.dot(far - a) > 0) || m.dot(n) < 0) continue;
    edges.push_back({a, b, (b - a).normalized(), (m + n).normalized()});
  }
  return edges;
}

/// The axis that two parallel edges of one wall have: both are equally far from it, along their inward directions.
std::optional<RoundHole> hole_of(const WallEdge& e, const WallEdge& f) {
  const auto across = [&](const Vec3& v) { return Vec3(v - v.dot(e.along) * e.along); };
  const Vec3 apart = across(e.center() - f.center()), turn = f.inward - e.inward;
  const double radius = apart.dot(turn) / turn.squaredNorm();
  if (!(turn.norm() > least_turn) || !(radius > 0) || (apart - radius * turn).norm() > round * radius)
    return std::nullopt;
  return RoundHole{e.center() + radius * e.inward, e.along, radius, 0, 0};
}

/// Whether an edge is one of the hole's wall.
bool belongs(const WallEdge& e, const RoundHole& hole) {
  if (std::abs(e.along.dot(hole.axis)) < least_cosine) return false;
  const Vec3 d = e.center() - hole.center, from = d - d.dot(hole.axis) * hole.axis;
  return std::abs(from.norm() - hole.radius) < round * hole.radius &&
         (from + hole.radius * e.inward).norm() < 10 * round * hole.radius;
}

/// Two directions across an axis.
std::array<Vec3, 2> across(const Vec3& axis) {
  const Vec3 x = axis.unitOrthogonal();
  return {x, axis.cross(x)};
}

double angle_of(const Vec3& p, const RoundHole& hole, const std::array<Vec3, 2>& frame) {
  return std::atan2((p - hole.center).dot(frame[1]), (p - hole.center).dot(frame[0]));
}

/// The wall around an axis: the widest angle between neighbouring edges (rad), and how near its facets come (m).
struct Wall {
  double widest = 0, nearest = std::numeric_limits<double>::infinity();
};

Wall wall_of(const std::vector<WallEdge>& edges, const RoundHole& hole) {
  const std::array<Vec3, 2> frame = across(hole.axis);
  std::vector<std::pair<double, double>> places;  // angle, distance
  for (const WallEdge& e : edges) {
    const Vec3 d = e.center() - hole.center;
    places.emplace_back(angle_of(e.center(), hole, frame), (d - d.dot(hole.axis) * hole.axis).norm());
  }
  std::sort(places.begin(), places.end());
  places.emplace_back(places.front().first + 2 * M_PI, places.front().second);
  Wall wall;
  for (std::size_t i = 0; i + 1 < places.size(); ++i) {
    const auto [u, p] = places[i];
    const auto [v, q] = places[i + 1];
    wall.widest = std::max(wall.widest, v - u);
    if (v - u < least_turn) continue;  // one above the other
    const double chord = std::sqrt(p * p + q * q - 2 * p * q * std::cos(v - u));
    wall.nearest = std::min(wall.nearest, p * q * std::sin(v - u) / chord);
  }
  return wall;
}

/// The part of a hull below a plane and that above it; empty where it has no volume.
std::pair<Mesh, Mesh> cut(const Mesh& hull, const Vec3& normal, double offset) {
  if (hull.empty()) return {};
  const auto sides = clip(hull, {normal, offset}, 1e-9 * hull.bounds().diagonal());
  return {convex_hull(sides.first.vertices, all_corners), convex_hull(sides.second.vertices, all_corners)};
}

/// The direction across the axis in which all of a hull is farthest from it, and by how much (negative: around it).
std::pair<double, Vec3> free_direction(const Mesh& hull, const RoundHole& hole) {
  constexpr int directions = 720;
  const std::array<Vec3, 2> frame = across(hole.axis);
  std::pair<double, Vec3> best{-std::numeric_limits<double>::infinity(), frame[0]};
  for (int i = 0; i < directions; ++i) {
    const double u = 2 * M_PI * i / directions;
    const Vec3 direction = std::cos(u) * frame[0] + std::sin(u) * frame[1];
    double least = std::numeric_limits<double>::infinity();
    for (const Vec3& v : hull.vertices) least = std::min(least, direction.dot(v - hole.center));
    if (least > best.first) best = {least, direction};
  }
  return best;
}

/// Sectors of a hull about the axis, from angle to angle.
std::vector<Mesh> sectors(const Mesh& hull, const RoundHole& hole, const Vec3& middle, double most) {
  const Vec3 side = hole.axis.cross(middle);
  double first = 0, last = 0;
  for (const Vec3& v : hull.vertices) {
    const double u = std::atan2((v - hole.center).dot(side), (v - hole.center).dot(middle));
    first = std::min(first, u);
    last = std::max(last, u);
  }
  const bool around = last - first > M_PI;
  const int count = std::max(1, static_cast<int>(std::ceil((last - first) / most - 1e-6)));
  std::vector<Mesh> out;
  for (int i = 0; i < count; ++i) {
    Mesh piece = hull;
    for (const double end : {0.0, 1.0}) {
      const double u = first + (last - first) * (i + end) / count;
      const Vec3 normal = std::cos(u) * side - std::sin(u) * middle;
      if (!around && (i + end == 0.0 || i + end == count)) continue;  // where the hull ends
      auto [below, above] = cut(piece, normal, normal.dot(hole.center));
      piece = end == 0.0 ? std::move(above) : std::move(below);
    }
    if (!piece.empty()) out.push_back(std::move(piece));
  }
  return out;
}

}  // namespace

std::vector<RoundHole> round_holes(const MeshQuery& query) {
  std::vector<WallEdge> edges = wall_edges(query.mesh());
  std::vector<RoundHole> holes;
  while (!edges.empty()) {
    const WallEdge seed = edges.back();
    edges.pop_back();
    std::vector<WallEdge> best;
    RoundHole hole{};
    double nearest = std::numeric_limits<double>::infinity();
    for (const WallEdge& e : edges) {  // the neighbour in the wall is the nearest edge that has an axis with it
      if (std::abs(e.along.dot(seed.along)) < least_cosine || (e.center() - seed.center()).norm() >= nearest) continue;
      const std::optional<RoundHole> found = hole_of(seed, e);
      if (!found) continue;
      nearest = (e.center() - seed.center()).norm();
      hole = *found;
    }
    if (nearest == std::numeric_limits<double>::infinity()) continue;
    std::vector<WallEdge> wall{seed}, others;
    for (const WallEdge& e : edges) (belongs(e, hole) ? wall : others).push_back(e);
    const Wall around = wall_of(wall, hole);
    if (around.widest > widest) continue;
    hole.low = std::numeric_limits<double>::infinity();
    hole.high = -hole.low;
    for (const WallEdge& e : wall)
      for (const Vec3& p : {e.start, e.end}) {
        hole.low = std::min(hole.low, hole.axis.dot(p - hole.center));
        hole.high = std::max(hole.high, hole.axis.dot(p - hole.center));
      }
    hole.radius = around.nearest;
    edges = std::move(others);
    if (!query.inside(hole.center + 0.5 * (hole.low + hole.high) * hole.axis)) holes.push_back(hole);
  }
  return holes;
}

std::vector<Mesh> cleared(std::vector<Mesh> hulls, const RoundHole& hole, double loss) {
  const double most = std::min(2 * std::acos(hole.radius / (hole.radius + loss)), widest_sector);
  const double slack = tolerance * hole.radius, base = hole.axis.dot(hole.center);
  const auto intrudes = [&](const Mesh& hull) {
    return !hull.empty() && free_direction(hull, hole).first < hole.radius - slack;
  };
  const auto cut_at = [&](const Mesh& hull, double height) { return cut(hull, hole.axis, base + height); };
  std::vector<Mesh> out;
  for (Mesh& hull : hulls) {
    if (!intrudes(cut_at(cut_at(hull, hole.low + slack).second, hole.high - slack).first)) {
      out.push_back(std::move(hull));
      continue;
    }
    // What closes the hole stays as it is.
    auto [below, rest] = cut_at(hull, hole.low - slack);
    if (intrudes(below)) {
      out.push_back(std::move(below));
      hull = std::move(rest);
    }
    auto [beside, above] = cut_at(hull, hole.high + slack);
    if (intrudes(above)) {
      out.push_back(std::move(above));
      hull = std::move(beside);
    }
    for (const Mesh& sector : sectors(hull, hole, free_direction(hull, hole).second, most)) {
      const Vec3 direction = free_direction(sector, hole).second;
      Mesh clear = cut(sector, direction, direction.dot(hole.center) + hole.radius).second;
      if (!clear.empty()) out.push_back(std::move(clear));
    }
  }
  return out;
}

}  // namespace bin_scenes
