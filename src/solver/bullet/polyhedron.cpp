#include "polyhedron.hpp"

#include "bin_scenes/core/contact.hpp"

#include "convert.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes::bullet {

namespace {

constexpr double same_direction = 0.9;  ///< cosine; a sliver's normal says little, its corners all

struct Flat {
  Vec3 normal, point;
  std::vector<std::uint32_t> corners;

  bool holds(const Vec3& x, double flat) const { return std::abs(normal.dot(x - point)) <= flat; }
};

/// Counter-clockwise seen from outside.
void turn_in_order(Flat& face, const std::vector<Vec3>& vertices) {
  std::sort(face.corners.begin(), face.corners.end());
  face.corners.erase(std::unique(face.corners.begin(), face.corners.end()), face.corners.end());
  Vec3 center = Vec3::Zero();
  for (const std::uint32_t v : face.corners) center += vertices[v] / static_cast<double>(face.corners.size());
  const Tangents along(face.normal);
  const auto angle = [&](std::uint32_t v) {
    return std::atan2(along.y.dot(vertices[v] - center), along.x.dot(vertices[v] - center));
  };
  std::sort(face.corners.begin(), face.corners.end(), [&](std::uint32_t u, std::uint32_t v) {
    const double at_u = angle(u), at_v = angle(v);
    return at_u != at_v ? at_u < at_v : u < v;
  });
}

}  // namespace

btConvexPolyhedron polyhedron_of(const Mesh& hull, double flat) {
  struct Facet {
    Vec3 normal;  // times twice the area
    double area;
    std::size_t triangle;
  };
  std::vector<Facet> facets;
  for (std::size_t t = 0; t < hull.triangles.size(); ++t) {
    const auto& [a, b, c] = hull.triangles[t];
    const Vec3 normal = (hull.vertices[b] - hull.vertices[a]).cross(hull.vertices[c] - hull.vertices[a]);
    if (normal.norm() > 0.0) facets.push_back({normal, normal.norm(), t});
  }
  // Large ones say which planes there are.
  std::sort(facets.begin(), facets.end(), [](const Facet& s, const Facet& t) {
    return s.area != t.area ? s.area > t.area : s.triangle < t.triangle;
  });
  std::vector<Flat> faces;
  for (const Facet& f : facets) {
    const Triangle& triangle = hull.triangles[f.triangle];
    const auto known = std::find_if(faces.begin(), faces.end(), [&](const Flat& face) {
      return face.normal.dot(f.normal) > same_direction * f.area &&
             std::all_of(triangle.begin(), triangle.end(),
                         [&](std::uint32_t v) { return face.holds(hull.vertices[v], flat); });
    });
    Flat& face = known != faces.end() ? *known : faces.emplace_back();
    if (face.corners.empty()) face = {f.normal / f.area, hull.vertices[triangle[0]], {}};
    face.corners.insert(face.corners.end(), triangle.begin(), triangle.end());
  }

  btConvexPolyhedron result;
  for (const Vec3& v : hull.vertices) result.m_vertices.push_back(to_bt(v));
  for (Flat& face : faces) {
    turn_in_order(face, hull.vertices);
    btFace out;
    for (const std::uint32_t v : face.corners) out.m_indices.push_back(static_cast<int>(v));
    for (int i = 0; i < 3; ++i) out.m_plane[i] = face.normal[i];
    out.m_plane[3] = -face.normal.dot(face.point);
    result.m_faces.push_back(out);
  }
  result.initialize();
  return result;
}

}  // namespace bin_scenes::bullet
