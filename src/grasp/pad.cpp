/// Triangles are clipped to the pad's rectangle and to what lies within its give of the highest point; area, centroid
/// and mean distance are then those of plane polygons, by formulas.
#include "grasp/pad.hpp"

#include "bin_scenes/core/assertion.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes {

namespace {

using Vec2 = Eigen::Vector2d;
using Polygon = std::vector<Vec3>;  // u, v, height

/// Keeps the side where sign * (coordinate - limit) <= 0 (Sutherland & Hodgman 1974).
void clip(Polygon& polygon, int coordinate, double sign, double limit) {
  static thread_local Polygon kept;
  kept.clear();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &here = polygon[i], &next = polygon[(i + 1) % polygon.size()];
    const double a = sign * (here[coordinate] - limit), b = sign * (next[coordinate] - limit);
    if (a <= 0.0) kept.push_back(here);
    if ((a < 0.0 && b > 0.0) || (a > 0.0 && b < 0.0)) kept.push_back(here + a / (a - b) * (next - here));
  }
  polygon.swap(kept);
}

/// A triangle within the pad's rectangle, seen from the pad.
struct Patch {
  Polygon polygon;
  Vec3 normal;  // along u, v, out
};

Aabb bounds_of(const Pad& pad) {
  Aabb box;
  for (const double height : {-2.0 * pad.give, pad.start})
    for (const double u : {-pad.half_u, pad.half_u})
      for (const double v : {-pad.half_v, pad.half_v})
        box.extend(pad.center + u * pad.u + v * pad.v + height * pad.out);
  return box;
}

/// All that the pad may meet on its path.
std::vector<Patch> patches_below(const MeshQuery& mesh, const Pad& pad) {
  std::vector<Patch> patches;
  const Mesh& m = mesh.mesh();
  mesh.overlapping(bounds_of(pad), [&](std::size_t t) {
    const Vec3 area = m.area_vector(t);
    const double length = area.norm();
    if (!(area.dot(pad.out) > 1e-9 * length)) return;
    Patch patch;
    patch.normal = Vec3(area.dot(pad.u), area.dot(pad.v), area.dot(pad.out)) / length;
    for (const std::uint32_t i : m.triangles[t]) {
      const Vec3 x = m.vertices[i] - pad.center;
      patch.polygon.emplace_back(x.dot(pad.u), x.dot(pad.v), x.dot(pad.out));
    }
    clip(patch.polygon, 0, 1.0, pad.half_u);
    clip(patch.polygon, 0, -1.0, -pad.half_u);
    clip(patch.polygon, 1, 1.0, pad.half_v);
    clip(patch.polygon, 1, -1.0, -pad.half_v);
    clip(patch.polygon, 2, 1.0, pad.start);
    if (patch.polygon.size() > 2) patches.push_back(std::move(patch));
  });
  return patches;
}

double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

bool contains(const Polygon& polygon, const Vec2& point) {
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 a = polygon[i].head<2>(), b = polygon[(i + 1) % polygon.size()].head<2>();
    if (cross(b - a, point - a) < 0.0) return false;
  }
  return true;
}

/// Area and centroid of the contact, and its mean normal.
struct Sums {
  double area = 0.0;
  Vec2 moment = Vec2::Zero();
  Vec3 normal = Vec3::Zero();
};

void add(Sums& sums, const Patch& patch) {
  const Vec2 a = patch.polygon[0].head<2>();
  for (std::size_t i = 2; i < patch.polygon.size(); ++i) {
    const Vec2 b = patch.polygon[i - 1].head<2>(), c = patch.polygon[i].head<2>();
    const double area = 0.5 * cross(b - a, c - a);
    sums.area += area;
    sums.moment += area / 3.0 * (a + b + c);
    sums.normal += area * patch.normal;
  }
}

void set_points(PadContact& contact, const std::vector<Patch>& patches, const Pad& pad) {
  constexpr int across = 3;
  std::vector<Vec2> small;
  for (int i = 0; i < across; ++i) {
    for (int j = 0; j < across; ++j) {
      const Vec2 point(((2 * i + 1) / double(across) - 1.0) * pad.half_u,
                       ((2 * j + 1) / double(across) - 1.0) * pad.half_v);
      const auto holds = [&](const Patch& patch) { return contains(patch.polygon, point); };
      if (std::any_of(patches.begin(), patches.end(), holds)) contact.points.push_back(point);
    }
  }
  for (std::size_t i = 0; contact.points.empty() && i < patches.size(); i += 1 + patches.size() / 8) {
    Vec3 sum = Vec3::Zero();
    for (const Vec3& corner : patches[i].polygon) sum += corner;
    small.push_back((sum / static_cast<double>(patches[i].polygon.size())).head<2>());
  }
  if (contact.points.empty()) contact.points = small;
}

}  // namespace

double distance_integral(const std::vector<Vec2>& polygon, const Vec2& from) {
  // Of the triangle between a point and an edge h away from it, seen under the angles a to b from the perpendicular,
  // the integral is h^3 / 6 (sec tan + ln(sec + tan)) from a to b.
  const auto primitive = [](double tangent) {
    const double secant = std::sqrt(1.0 + tangent * tangent);
    return secant * tangent + std::asinh(tangent);
  };
  double sum = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 a = polygon[i] - from, b = polygon[(i + 1) % polygon.size()] - from;
    const double length = (b - a).norm();
    if (!(length > 0.0)) continue;
    const Vec2 along = (b - a) / length;
    const double h = cross(a, along);  // > 0: the edge goes round counter-clockwise
    if (std::abs(h) <= 1e-12 * length) continue;
    const double from_a = a.dot(along) / std::abs(h), to_b = b.dot(along) / std::abs(h);
    sum += h * h * h / 6.0 * (primitive(to_b) - primitive(from_a));
  }
  return sum;
}

std::optional<PadContact> press(const MeshQuery& mesh, const Pad& pad) {
  std::vector<Patch> patches = patches_below(mesh, pad);
  if (patches.empty()) return std::nullopt;
  PadContact contact;
  contact.height = -std::numeric_limits<double>::infinity();
  for (const Patch& patch : patches)
    for (const Vec3& x : patch.polygon) contact.height = std::max(contact.height, x.z());
  if (contact.height >= pad.start * (1.0 - 1e-9)) return std::nullopt;

  const double steepest = 1.0 / std::sqrt(1.0 + pad.friction * pad.friction);  // cosine of the cone's half angle
  Sums sums;
  for (Patch& patch : patches) {
    if (patch.normal.z() < steepest * (1.0 - 1e-9)) patch.polygon.clear();
    clip(patch.polygon, 2, -1.0, contact.height - pad.give);
    if (patch.polygon.size() > 2) add(sums, patch);
  }
  patches.erase(std::remove_if(patches.begin(), patches.end(), [](const Patch& p) { return p.polygon.size() < 3; }),
                patches.end());
  if (!(sums.area > 0.0)) return std::nullopt;
  contact.share = sums.area / (4.0 * pad.half_u * pad.half_v);
  contact.centroid = sums.moment / sums.area;
  contact.friction = sums.normal.head<2>().norm() / sums.normal.z();
  contact.lower = contact.upper = contact.centroid;
  double distances = 0.0;
  for (const Patch& patch : patches) {
    std::vector<Vec2> flat;
    for (const Vec3& x : patch.polygon) flat.push_back(x.head<2>());
    for (const Vec2& x : flat) {
      contact.lower = contact.lower.cwiseMin(x);
      contact.upper = contact.upper.cwiseMax(x);
    }
    distances += distance_integral(flat, contact.centroid);
  }
  contact.radius = distances / sums.area;
  set_points(contact, patches, pad);
  return contact;
}

}  // namespace bin_scenes
