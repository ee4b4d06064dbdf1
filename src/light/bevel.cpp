#include "light/bevel.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace bin_scenes {

namespace {

constexpr double sharpest_smooth = 0.82;  ///< cosine of 35 degrees: faces that meet in less are one curved surface

/// The half edges of a mesh by their ends, in ascending order.
using EdgeUses = std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>>;

EdgeUses triangles_at_edges(const Mesh& mesh) {
  EdgeUses uses;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& corners = mesh.triangles[t];
    for (std::size_t k = 0; k < 3; ++k) uses[std::minmax(corners[k], corners[(k + 1) % 3])].push_back(t);
  }
  return uses;
}

double furthest_along(const Mesh& mesh, std::uint32_t triangle, const Vec3& normal) {
  double most = -std::numeric_limits<double>::infinity();
  for (const std::uint32_t corner : mesh.triangles[triangle]) most = std::max(most, normal.dot(mesh.vertices[corner]));
  return most;
}

}  // namespace

Bevels::Bevels(const Scenery& scenery, double radius) : radius_(radius) {
  std::map<const Mesh*, std::shared_ptr<const EdgesOfMesh>> known;
  for (std::size_t i = 0; i < scenery.body_count(); ++i) {
    const Scenery::Body body = scenery.body(i);
    bodies_.push_back({nullptr, body.planes, body.pose});
    if (body.part < 0) continue;
    auto& edges = known[body.mesh];
    if (!edges) edges = edges_of(*body.mesh, *body.planes);
    bodies_.back().edges = edges;
  }
}

std::shared_ptr<const Bevels::EdgesOfMesh> Bevels::edges_of(const Mesh& mesh,
                                                            const std::vector<Scenery::Plane>& planes) const {
  auto all = std::make_shared<EdgesOfMesh>();
  double longest = 0.0;
  for (const auto& [ends, triangles] : triangles_at_edges(mesh)) {
    if (triangles.size() != 2) continue;
    const Scenery::Plane &a = planes[triangles[0]], &b = planes[triangles[1]];
    const double cosine = a.normal.dot(b.normal), tolerance = 1e-3 * radius_;
    const bool convex = furthest_along(mesh, triangles[1], a.normal) < a.offset + tolerance;
    if (!(cosine < sharpest_smooth && convex)) continue;
    const Vec3 &from = mesh.vertices[ends.first], span = mesh.vertices[ends.second] - from;
    // tan(angle / 2), which a knife edge would take to infinity.
    const double reach = radius_ * std::min(std::sqrt((1.0 - cosine) / std::max(1.0 + cosine, 1e-9)), 4.0);
    all->edges.push_back({from, span.normalized(), span.norm(), a.normal, b.normal, reach});
    all->edges.push_back({from, span.normalized(), span.norm(), b.normal, a.normal, reach});
    longest = std::max(longest, span.norm());
  }
  std::sort(all->edges.begin(), all->edges.end(), [](const Edge& a, const Edge& b) { return a.from.x() < b.from.x(); });
  const double margin = 4.0 * radius_;
  all->first.push_back(0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    Aabb box;
    for (const std::uint32_t corner : mesh.triangles[t]) box.extend(mesh.vertices[corner]);
    const auto from = std::lower_bound(all->edges.begin(), all->edges.end(), box.lower.x() - longest - margin,
                                       [](const Edge& edge, double x) { return edge.from.x() < x; });
    for (auto edge = from; edge != all->edges.end() && edge->from.x() < box.upper.x() + longest + margin; ++edge) {
      Aabb around;
      around.extend(edge->from);
      around.extend(edge->from + edge->length * edge->along);
      if (around.overlaps(box, edge->reach) && edge->own.dot(planes[t].normal) > sharpest_smooth)
        all->near.push_back(static_cast<std::uint32_t>(edge - all->edges.begin()));
    }
    all->first.push_back(static_cast<std::uint32_t>(all->near.size()));
  }
  return all;
}

/// A fillet of radius r touches both faces. The line through a point of a face at distance x from the edge, parallel to
/// the bisector b, meets it where its normal includes the angle a with b: r sin a = x cos(half the angle of the faces).
Vec3 Bevels::normal(const Hit& hit, const Vec3& point, const Vec3& smooth) const {
  if (hit.body >= bodies_.size() || !bodies_[hit.body].edges) return smooth;
  const Body& body = bodies_[hit.body];
  const EdgesOfMesh& all = *body.edges;
  const Quat back = body.pose.orientation.conjugate();
  const Vec3 normal = back * smooth, here = back * (point - body.pose.position);
  if (!(normal.dot((*body.planes)[hit.triangle].normal) > 0.0)) return smooth;
  Vec3 sum = normal;
  for (std::uint32_t i = all.first[hit.triangle]; i < all.first[hit.triangle + 1]; ++i) {
    const Edge& edge = all.edges[all.near[i]];
    const Vec3 offset = here - edge.from;
    const double away = (offset - std::clamp(offset.dot(edge.along), 0.0, edge.length) * edge.along).norm();
    if (away >= edge.reach) continue;
    const Vec3 bisector = (normal + edge.other).normalized();
    const double half = normal.dot(bisector), sine = away * half / radius_;
    if (sine * sine >= 1.0 - half * half) continue;
    const Vec3 across = (normal - half * bisector).normalized();
    sum += std::sqrt(1.0 - sine * sine) * bisector + sine * across - normal;
  }
  return body.pose.orientation * sum.normalized();
}

}  // namespace bin_scenes
