/// Triangles are clipped to the pad's rectangle and to what lies within its give of the highest point; area, centroid
/// and mean distance are then those of plane polygons, by formulas.
#include "grasp/pad.hpp"

#include "part/tree_walk.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes {

namespace {

using Vec2 = Eigen::Vector2d;
using Polygon = PadFacet::Polygon;

/// Keeps the side where sign * (coordinate - limit) <= 0 (Sutherland & Hodgman 1974).
void clip(Polygon& polygon, int coordinate, double sign, double limit) {
  std::array<double, Polygon::most> beyond;
  int count = 0;
  for (int i = 0; i < polygon.count; ++i) {
    beyond[i] = sign * (polygon.points[i][coordinate] - limit);
    count += beyond[i] > 0.0;
  }
  if (count == 0) return;
  if (count == polygon.count) {
    polygon.count = 0;
    return;
  }
  Polygon kept;
  for (int i = 0; i < polygon.count; ++i) {
    const int next = i + 1 < polygon.count ? i + 1 : 0;
    const double a = beyond[i], b = beyond[next];
    if (a <= 0.0) kept.add(polygon.points[i]);
    if ((a < 0.0 && b > 0.0) || (a > 0.0 && b < 0.0))
      kept.add(polygon.points[i] + a / (a - b) * (polygon.points[next] - polygon.points[i]));
  }
  polygon.count = kept.count;
  std::copy_n(kept.points.begin(), kept.count, polygon.points.begin());
}

Aabb bounds_of(const Pad& pad) {
  Aabb box;
  for (const double height : {-2.0 * pad.give, pad.start})
    for (const double u : {-pad.half_u, pad.half_u})
      for (const double v : {-pad.half_v, pad.half_v})
        box.extend(pad.center + u * pad.u + v * pad.v + height * pad.out);
  return box;
}

void clip_to_rectangle(Polygon& polygon, const Pad& pad) {
  clip(polygon, 0, 1.0, pad.half_u);
  clip(polygon, 0, -1.0, -pad.half_u);
  clip(polygon, 1, 1.0, pad.half_v);
  clip(polygon, 1, -1.0, -pad.half_v);
}

/// The triangle as the pad sees it; none if it faces away, is beside the pad, or is lower than `least`.
std::optional<PadFacet> facet_of(const Mesh& mesh, std::size_t triangle, const Pad& pad, double least) {
  PadFacet facet;
  for (const std::uint32_t i : mesh.triangles[triangle]) {
    const Vec3 x = mesh.vertices[i] - pad.center;
    facet.polygon.add({x.dot(pad.u), x.dot(pad.v), x.dot(pad.out)});
  }
  if (facet.polygon.highest() < least) return std::nullopt;
  clip_to_rectangle(facet.polygon, pad);
  if (facet.polygon.count < 3) return std::nullopt;
  const Vec3 area = mesh.area_vector(triangle);
  const double length = area.norm();
  if (!(area.dot(pad.out) > 1e-9 * length)) return std::nullopt;
  facet.normal = Vec3(area.dot(pad.u), area.dot(pad.v), area.dot(pad.out)) / length;
  return facet;
}

/// Whether a box is certainly beside the pad or lower than `least`.
bool is_apart(const Aabb& box, const Pad& pad, double least) {
  const Vec3 mid = box.center() - pad.center, half = 0.5 * box.size();
  const double rounding = 1e-9 * (pad.half_u + pad.half_v);
  const auto reach = [&](const Vec3& axis) { return axis.cwiseAbs().dot(half) + rounding; };
  return std::abs(mid.dot(pad.u)) > pad.half_u + reach(pad.u) || std::abs(mid.dot(pad.v)) > pad.half_v + reach(pad.v) ||
         mid.dot(pad.out) + reach(pad.out) < least;
}

double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

bool contains(const Polygon& polygon, const Vec2& point) {
  for (int i = 0; i < polygon.count; ++i) {
    const Vec2 a = polygon.points[i].head<2>(), b = polygon.points[(i + 1) % polygon.count].head<2>();
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

void add(Sums& sums, const PadFacet& facet) {
  const auto& points = facet.polygon.points;
  const Vec2 a = points[0].head<2>();
  for (int i = 2; i < facet.polygon.count; ++i) {
    const Vec2 b = points[i - 1].head<2>(), c = points[i].head<2>();
    const double area = 0.5 * cross(b - a, c - a);
    sums.area += area;
    sums.moment += area / 3.0 * (a + b + c);
    sums.normal += area * facet.normal;
  }
}

void set_points(PadContact& contact, const std::vector<PadFacet>& facets, const Pad& pad) {
  constexpr int across = 3;
  std::vector<Vec2> small;
  for (int i = 0; i < across; ++i) {
    for (int j = 0; j < across; ++j) {
      const Vec2 point(((2 * i + 1) / double(across) - 1.0) * pad.half_u,
                       ((2 * j + 1) / double(across) - 1.0) * pad.half_v);
      const auto holds = [&](const PadFacet& facet) { return contains(facet.polygon, point); };
      if (std::any_of(facets.begin(), facets.end(), holds)) contact.points.push_back(point);
    }
  }
  for (std::size_t i = 0; contact.points.empty() && i < facets.size(); i += 1 + facets.size() / 8) {
    const Polygon& polygon = facets[i].polygon;
    Vec3 sum = Vec3::Zero();
    for (int k = 0; k < polygon.count; ++k) sum += polygon.points[k];
    small.push_back((sum / static_cast<double>(polygon.count)).head<2>());
  }
  if (contact.points.empty()) contact.points = small;
}

/// Calls `use(facet)` for each triangle that the pad sees, until it returns true; those lower than `least` may be left
/// out, which `use` may raise.
template <class Use>
void for_each_facet(const MeshQuery& query, const Pad& pad, const double& least, const Use& use) {
  const Aabb bounds = bounds_of(pad);
  const Mesh& mesh = query.mesh();
  any_near(
      query, [&](const Aabb& box) { return !box.overlaps(bounds) || is_apart(box, pad, least); },
      [&](std::size_t triangle) {
        Aabb box;
        for (const std::uint32_t v : mesh.triangles[triangle]) box.extend(mesh.vertices[v]);
        if (!box.overlaps(bounds)) return false;
        const std::optional<PadFacet> facet = facet_of(mesh, triangle, pad, least);
        return facet && use(*facet);
      });
}

}  // namespace

double PadFacet::Polygon::highest() const {
  double height = -std::numeric_limits<double>::infinity();
  for (int i = 0; i < count; ++i) height = std::max(height, points[static_cast<std::size_t>(i)].z());
  return height;
}

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

std::optional<PressedPad> PressedPad::on(const MeshQuery& mesh, const Pad& pad) {
  double height = -std::numeric_limits<double>::infinity();
  const double start = pad.start * (1.0 - 1e-9);
  for_each_facet(mesh, pad, height, [&](const PadFacet& facet) {
    height = std::max(height, facet.polygon.highest());
    return height >= start;
  });
  if (height >= start || !std::isfinite(height)) return std::nullopt;
  return PressedPad(mesh, pad, height);
}

std::optional<PadContact> PressedPad::contact() const {
  const double steepest = 1.0 / std::sqrt(1.0 + pad_.friction * pad_.friction);  // cosine of the cone's half angle
  const double lowest = height_ - pad_.give;
  std::vector<PadFacet> facets;
  Sums sums;
  for_each_facet(mesh_, pad_, lowest, [&](PadFacet facet) {
    if (facet.normal.z() < steepest * (1.0 - 1e-9)) return false;
    clip(facet.polygon, 2, -1.0, lowest);
    if (facet.polygon.count < 3) return false;
    add(sums, facet);
    facets.push_back(facet);
    return false;
  });
  if (!(sums.area > 0.0)) return std::nullopt;
  PadContact contact;
  contact.share = sums.area / (4.0 * pad_.half_u * pad_.half_v);
  contact.centroid = sums.moment / sums.area;
  contact.friction = sums.normal.head<2>().norm() / sums.normal.z();
  contact.lower = contact.upper = contact.centroid;
  double distances = 0.0;
  std::vector<Vec2> flat;
  for (const PadFacet& facet : facets) {
    flat.clear();
    for (int i = 0; i < facet.polygon.count; ++i) flat.emplace_back(facet.polygon.points[i].head<2>());
    for (const Vec2& x : flat) {
      contact.lower = contact.lower.cwiseMin(x);
      contact.upper = contact.upper.cwiseMax(x);
    }
    distances += distance_integral(flat, contact.centroid);
  }
  contact.radius = distances / sums.area;
  set_points(contact, facets, pad_);
  return contact;
}

}  // namespace bin_scenes
