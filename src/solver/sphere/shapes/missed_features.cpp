/// Nodes where the samples miss what sticks out: vertices, ridges of curved faces, and the tips where sharp edges meet.
#include "solver/sphere/shapes/missed_features.hpp"

#include "solver/sphere/shapes/point_grid.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace bin_scenes::sphere {

double bulge(const Cone& cone, double face_spacing) {
  return 0.25 * std::min(cone.spread, 0.6f) * face_spacing;
}

namespace {

/// A vertex without a node, and the faces around it.
struct Vertex {
  std::vector<std::uint32_t> neighbours;
  std::vector<Vec3> normals;

  /// Mean normal of the faces.
  Vec3 out() const {
    Vec3 sum = Vec3::Zero();
    for (const Vec3& normal : normals) sum += normal;
    return sum.normalized();
  }
  /// rad: farthest that a face leans off their mean.
  double spread() const {
    double least = 1;
    for (const Vec3& normal : normals) least = std::min(least, normal.dot(out()));
    return std::acos(std::max(-1.0, least));
  }
};

/// Of a rounded surface no vertex spreads as far: this one is a tip.
constexpr double tip_spread = 0.6;  // rad

/// Normal cone of a vertex from all its neighbours, or, if they are too many, about the mean normal of its faces.
Cone vertex_cone(const Mesh& mesh, std::uint32_t v, const Vertex& vertex) {
  Cone cone;
  if (vertex.neighbours.size() > static_cast<std::size_t>(Cone::max_bounds)) {
    if (vertex.spread() < tip_spread) return cone;
    cone.axis = vertex.out().cast<float>();
    cone.spread = static_cast<float>(vertex.spread());
    return cone;
  }
  for (const std::uint32_t other : vertex.neighbours)
    cone.bound[cone.bounds++] = (mesh.vertices[other] - mesh.vertices[v]).normalized().cast<float>();
  return cone;
}

/// By vertex; empty for those that have nodes.
std::vector<Vertex> vertices_without_nodes(const Mesh& mesh, const Draft& draft) {
  std::vector<Vertex> vertices(mesh.vertices.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t v = mesh.triangles[t][i];
      if (draft.at_vertex[v] != Draft::none) continue;
      vertices[v].neighbours.push_back(mesh.triangles[t][(i + 1) % 3]);  // of a closed mesh these are all
      vertices[v].normals.push_back(mesh.area_vector(t).normalized());
    }
  return vertices;
}

/// Whether the nodes of a draft feel what touches the surface at a point between them: whether one near it is no lower
/// than `most` (m), or slides there along its face.
class Feeling {
 public:
  Feeling(const Draft& draft, double face_spacing, double most)
      : draft_(draft), face_spacing_(face_spacing), most_(most), grid_(draft.nodes, face_spacing) {}

  /// `out`: normal of the surface at the point.
  bool feels(const Vec3& x, const Vec3& out) {
    if (draft_.nodes.size() > in_grid_ + most_beside_) {
      grid_ = PointGrid(draft_.nodes, face_spacing_);
      in_grid_ = draft_.nodes.size();
    }
    const auto felt_by = [&](std::size_t i) {
      constexpr double slid = 0.7;  // of the longest displacement of a node along its face: it may end early
      const Vec3 moved = x - draft_.nodes[i];
      const Vec3f& axis = draft_.cones[i].axis;
      const double height = moved.dot(out);
      return height <= most_ || (height <= bulge(draft_.cones[i], face_spacing_) &&
                                 moved.norm() < slid * face_spacing_ && axis.cast<double>().dot(out) > 0.5);
    };
    if (grid_.any_within(x, face_spacing_, felt_by)) return true;
    for (std::size_t i = in_grid_; i < draft_.nodes.size(); ++i)
      if ((x - draft_.nodes[i]).norm() < face_spacing_ && felt_by(i)) return true;
    return false;
  }

 private:
  static constexpr std::size_t most_beside_ =
      256;  ///< nodes that are looked at one by one until the grid takes them in

  const Draft& draft_;
  double face_spacing_, most_;
  PointGrid grid_;
  std::size_t in_grid_ = draft_.nodes.size();
};

}  // namespace

void add_missed_vertices(const Mesh& mesh, double face_spacing, double most, Draft& draft) {
  const std::vector<Vertex> vertices = vertices_without_nodes(mesh, draft);
  Feeling nodes(draft, face_spacing, most);
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    if (draft.at_vertex[v] != Draft::none) continue;
    const Vec3 &x = mesh.vertices[v], out = vertices[v].out();
    const auto below = [&](std::uint32_t other) { return out.dot(mesh.vertices[other] - x) <= 0; };
    const auto& neighbours = vertices[v].neighbours;
    if (!std::all_of(neighbours.begin(), neighbours.end(), below)) continue;  // it cannot touch first
    // What touches a tip sideways is not felt by the nodes of a face beside it, nor by those of a line that ends there.
    if (vertices[v].spread() > tip_spread || !nodes.feels(x, out))
      draft.at_vertex[v] = draft.add(x, vertex_cone(mesh, v, vertices[v]));
  }
}

namespace {

/// Directions across a line of a rounded edge, as far as the line stands for its neighbours; none along it.
Cone ridge_cone(const Vec3& along, const Vec3& out) {
  constexpr double to_each_side = 0.6;  // rad
  const Vec3 across = along.cross(out);
  const Vec3 left = std::cos(to_each_side) * across - std::sin(to_each_side) * out;
  const Vec3 right = -std::cos(to_each_side) * across - std::sin(to_each_side) * out;
  Cone cone;
  for (const Vec3& bound : {left, right, along, Vec3(-along)}) cone.bound[cone.bounds++] = bound.cast<float>();
  return cone;
}

}  // namespace

void add_missed_ridges(const Mesh& mesh, double face_spacing, double spacing, double most, Draft& draft) {
  struct Side {
    std::uint32_t a, b, beyond;  ///< a < b; third corner of its triangle
    std::size_t triangle;
  };
  std::vector<Side> sides;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) {
      const auto [a, b] = std::minmax(mesh.triangles[t][i], mesh.triangles[t][(i + 1) % 3]);
      if ((mesh.vertices[b] - mesh.vertices[a]).norm() > 0.5 * face_spacing)
        sides.push_back({a, b, mesh.triangles[t][(i + 2) % 3], t});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& s, const Side& t) {
    return std::tie(s.a, s.b, s.triangle) < std::tie(t.a, t.b, t.triangle);
  });
  Feeling nodes(draft, face_spacing, most);
  for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
    const Side &one = sides[i], &other = sides[i + 1];
    if (one.a != other.a || one.b != other.b) continue;
    const Vec3 a = mesh.vertices[one.a], b = mesh.vertices[one.b], along = (b - a).normalized();
    const Vec3 normal = mesh.area_vector(one.triangle).normalized();
    const Vec3 beyond = mesh.vertices[other.beyond] - a;
    constexpr double least_bend = 0.02;                                                            // rad
    if (-normal.dot(beyond) < least_bend * (beyond - beyond.dot(along) * along).norm()) continue;  // flat, or concave
    const Vec3 out = (normal + mesh.area_vector(other.triangle).normalized()).normalized();
    const int pieces = static_cast<int>(std::ceil((b - a).norm() / (0.5 * face_spacing)));
    bool missed = false;
    for (int k = 1; k < pieces && !missed; ++k)
      missed = !nodes.feels(a + (b - a) * (static_cast<double>(k) / pieces), out);
    if (!missed) continue;
    const Cone cone = ridge_cone(along, out);
    for (const std::uint32_t v : {one.a, one.b})
      if (draft.at_vertex[v] == Draft::none) draft.at_vertex[v] = draft.add(mesh.vertices[v], cone);
    draft.add_edge(mesh, one.a, one.b, cone, false, spacing);
  }
}

}  // namespace bin_scenes::sphere
