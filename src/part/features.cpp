/// Edges at which the surface folds outwards, joined into curves, and the corners where curves meet. Slivers borrow the
/// normal of a neighbour.
#include "bin_scenes/part/features.hpp"

#include "bin_scenes/core/assertion.hpp"

#include <algorithm>
#include <cstdint>
#include <tuple>

namespace bin_scenes {
namespace {

// A triangle lower than this / diagonal over its longest edge is a sliver.
constexpr double sliver_limit = 1e-5;

/// Half of an edge as one triangle sees it; `low` < `high` are its vertices.
struct HalfEdge {
  std::uint32_t low, high, triangle;
  bool forward;  // the triangle runs from low to high

  bool same_edge(const HalfEdge& other) const { return low == other.low && high == other.high; }
  bool operator<(const HalfEdge& other) const {
    return std::tie(low, high, triangle) < std::tie(other.low, other.high, other.triangle);
  }
};

std::vector<HalfEdge> sorted_half_edges(const Mesh& mesh) {
  std::vector<HalfEdge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
      if (a != b) edges.push_back({std::min(a, b), std::max(a, b), t, a < b});
    }
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

/// Unit normal of every triangle; a sliver borrows it across its longest edge, and keeps zero if nothing is there.
std::vector<Vec3> face_normals(const Mesh& mesh, const std::vector<HalfEdge>& edges) {
  std::vector<Vec3> normals(mesh.triangles.size(), Vec3::Zero());
  std::vector<std::uint8_t> sliver(mesh.triangles.size(), 0);
  const double lowest = sliver_limit * mesh.bounds().diagonal();
  const auto edge_length = [&](const HalfEdge& e) { return (mesh.vertices[e.high] - mesh.vertices[e.low]).norm(); };
  std::vector<double> longest(mesh.triangles.size(), 0.0);
  for (const HalfEdge& e : edges) longest[e.triangle] = std::max(longest[e.triangle], edge_length(e));
  for (std::size_t t = 0; t < normals.size(); ++t) {
    const Vec3 area = mesh.area_vector(t);
    const double twice_area = area.norm();
    sliver[t] = !(twice_area > lowest * longest[t]);
    if (!sliver[t]) normals[t] = area / twice_area;
  }
  // Slivers lie beside slivers where a fan was cut fine; a few rounds reach through them.
  constexpr int rounds = 4;
  for (int round = 0; round < rounds; ++round) {
    std::vector<Vec3> borrowed = normals;
    for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
      if (!edges[i].same_edge(edges[i + 1])) continue;
      const auto lend = [&](const HalfEdge& to, const HalfEdge& from) {
        if (sliver[to.triangle] && edge_length(to) >= longest[to.triangle] && normals[to.triangle].isZero()) {
          borrowed[to.triangle] = normals[from.triangle];
        }
      };
      lend(edges[i], edges[i + 1]);
      lend(edges[i + 1], edges[i]);
    }
    normals.swap(borrowed);
  }
  return normals;
}

struct SharpEdge {
  std::array<std::uint32_t, 2> ends;
  Vec3 normal;
};

std::vector<SharpEdge> sharp_edges(const Mesh& mesh, const std::vector<HalfEdge>& half_edges,
                                   const std::vector<Vec3>& normals, double sharp_angle) {
  std::vector<SharpEdge> sharp;
  const double cos_sharp = std::cos(sharp_angle);
  for (std::size_t i = 0; i < half_edges.size();) {
    std::size_t end = i + 1;
    while (end < half_edges.size() && half_edges[end].same_edge(half_edges[i])) ++end;
    const HalfEdge& e = half_edges[i];
    Vec3 sum = Vec3::Zero();
    for (std::size_t k = i; k < end; ++k) sum += normals[half_edges[k].triangle];
    bool is_sharp = true;  // one face (open) or more than two (bodies touching in an edge)
    if (end - i == 2) {
      const HalfEdge& other = half_edges[i + 1];
      const Vec3 &n1 = normals[e.triangle], &n2 = normals[other.triangle];
      const Vec3 along = (e.forward ? 1.0 : -1.0) * (mesh.vertices[e.high] - mesh.vertices[e.low]);
      is_sharp = !n1.isZero() && !n2.isZero() && n1.dot(n2) < cos_sharp && n1.cross(n2).dot(along) > 0;
    }
    if (is_sharp && sum.norm() > 1e-6) sharp.push_back({{e.low, e.high}, sum.normalized()});
    i = end;
  }
  return sharp;
}

/// Faces around a vertex, weighted by their angle there (Thuermer & Wuethrich 1998).
std::vector<Vec3> vertex_normals(const Mesh& mesh, const std::vector<Vec3>& face_normals) {
  std::vector<Vec3> normals(mesh.vertices.size(), Vec3::Zero());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const Vec3& here = mesh.vertices[mesh.triangles[t][k]];
      const Vec3 u = mesh.vertices[mesh.triangles[t][(k + 1) % 3]] - here;
      const Vec3 v = mesh.vertices[mesh.triangles[t][(k + 2) % 3]] - here;
      normals[mesh.triangles[t][k]] += std::atan2(u.cross(v).norm(), u.dot(v)) * face_normals[t];
    }
  }
  for (Vec3& n : normals) n.normalize();
  return normals;
}

/// Joins sharp edges into curves from corner to corner.
class CurveTracer {
 public:
  CurveTracer(const Mesh& mesh, const std::vector<SharpEdge>& edges, double sharp_angle)
      : mesh_(mesh), edges_(edges), used_(edges.size(), 0), corner_(mesh.vertices.size(), 0) {
    // Edges of each vertex, as one run per vertex.
    first_.assign(mesh.vertices.size() + 1, 0);
    for (const SharpEdge& e : edges)
      for (const std::uint32_t v : e.ends) ++first_[v + 1];
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) first_[v + 1] += first_[v];
    BIN_SCENES_ASSERT(first_.back() == 2 * edges.size());
    around_.resize(2 * edges.size());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::uint32_t i = 0; i < edges.size(); ++i)
      for (const std::uint32_t v : edges[i].ends) around_[next[v]++] = i;

    const double cos_sharp = std::cos(sharp_angle);
    for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
      const std::uint32_t degree = first_[v + 1] - first_[v];
      if (degree == 2) {
        const Vec3 in = mesh.vertices[v] - mesh.vertices[other_end(around_[first_[v]], v)];
        const Vec3 out = mesh.vertices[other_end(around_[first_[v] + 1], v)] - mesh.vertices[v];
        corner_[v] = in.dot(out) < cos_sharp * in.norm() * out.norm();
      } else {
        corner_[v] = degree > 0;
      }
    }
  }

  bool is_corner(std::uint32_t v) const { return corner_[v]; }

  std::vector<FeatureCurve> trace() {
    std::vector<FeatureCurve> curves;
    for (std::uint32_t i = 0; i < edges_.size(); ++i) {
      for (const std::uint32_t end : edges_[i].ends) {
        if (!used_[i] && corner_[end]) curves.push_back(follow(i, end));
      }
    }
    for (std::uint32_t i = 0; i < edges_.size(); ++i) {  // what is left are loops without a corner
      if (!used_[i]) curves.push_back(follow(i, edges_[i].ends[0]));
    }
    return curves;
  }

 private:
  std::uint32_t other_end(std::uint32_t edge, std::uint32_t v) const {
    return edges_[edge].ends[edges_[edge].ends[0] == v ? 1 : 0];
  }

  FeatureCurve follow(std::uint32_t edge, std::uint32_t start) {
    FeatureCurve curve;
    curve.points.push_back(mesh_.vertices[start]);
    std::uint32_t v = start;
    for (;;) {
      used_[edge] = 1;
      v = other_end(edge, v);
      curve.points.push_back(mesh_.vertices[v]);
      curve.normals.push_back(edges_[edge].normal);
      if (corner_[v] || v == start) break;
      edge = around_[first_[v]] == edge ? around_[first_[v] + 1] : around_[first_[v]];
    }
    curve.closed = v == start && !corner_[v];
    BIN_SCENES_ASSERT(curve.points.size() == curve.normals.size() + 1);
    BIN_SCENES_ASSERT(!curve.closed || curve.points.front() == curve.points.back());
    return curve;
  }

  const Mesh& mesh_;
  const std::vector<SharpEdge>& edges_;
  std::vector<std::uint8_t> used_, corner_;
  std::vector<std::uint32_t> first_, around_;
};

}  // namespace

double FeatureCurve::length() const {
  double sum = 0;
  for (std::size_t i = 1; i < points.size(); ++i) sum += (points[i] - points[i - 1]).norm();
  return sum;
}

Features sharp_features(const Mesh& mesh, double sharp_angle) {
  const std::vector<HalfEdge> half_edges = sorted_half_edges(mesh);
  const std::vector<Vec3> normals = face_normals(mesh, half_edges);
  const std::vector<SharpEdge> edges = sharp_edges(mesh, half_edges, normals, sharp_angle);
  const std::vector<Vec3> at_vertices = vertex_normals(mesh, normals);
  BIN_SCENES_ASSERT(each_is(edges, [](const SharpEdge& edge) { return is_unit(edge.normal); }));
  CurveTracer tracer(mesh, edges, sharp_angle);
  Features features;
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    if (tracer.is_corner(v)) features.corners.push_back({mesh.vertices[v], at_vertices[v]});
  }
  features.curves = tracer.trace();
  return features;
}

}  // namespace bin_scenes
