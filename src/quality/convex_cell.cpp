/// Cuts a polyhedron by planes and caps it, and finds the least translation that separates two. Pairs of edges are left
/// out by bounds before they are tested.
#include "convex_cell.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/core/contact.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace bin_scenes {

/// Scratch memory of one cut.
struct ConvexCell::Clipping {
  struct Cut {
    int first, second, vertex;
  };
  std::vector<double> height;
  std::vector<Vec3> kept;
  std::vector<int> renumbered, cap, loops;
  std::vector<Cut> cuts;
  std::vector<std::pair<double, int>> order;
};

ConvexCell::ConvexCell(const Aabb& box) : tolerance_(1e-10 * box.diagonal()) {
  for (int i = 0; i < 8; ++i) {
    vertices_.emplace_back((i & 1 ? box.upper : box.lower).x(), (i & 2 ? box.upper : box.lower).y(),
                           (i & 4 ? box.upper : box.lower).z());
  }
  faces_ = {{{-Vec3::UnitX(), -box.lower.x()}, 0, 4},  {{Vec3::UnitX(), box.upper.x()}, 4, 4},
            {{-Vec3::UnitY(), -box.lower.y()}, 8, 4},  {{Vec3::UnitY(), box.upper.y()}, 12, 4},
            {{-Vec3::UnitZ(), -box.lower.z()}, 16, 4}, {{Vec3::UnitZ(), box.upper.z()}, 20, 4}};
  loops_ = {0, 4, 6, 2, 1, 3, 7, 5, 0, 1, 5, 4, 2, 6, 7, 3, 0, 2, 3, 1, 4, 5, 7, 6};
}

/// Of the vertices above the plane; whether some lie below it, and some above.
std::pair<bool, bool> ConvexCell::measure_heights(const Plane& plane, Clipping& c) const {
  c.height.resize(vertices_.size());
  bool any_in = false, any_out = false;
  for (std::size_t v = 0; v < vertices_.size(); ++v) {
    c.height[v] = plane.above(vertices_[v]);
    if (std::abs(c.height[v]) <= tolerance_) c.height[v] = 0.0;
    any_in |= c.height[v] < 0.0;
    any_out |= c.height[v] > 0.0;
  }
  return {any_in, any_out};
}

/// The cap is convex: its corners in order of angle about their centre.
void ConvexCell::add_cap(const Plane& plane, Clipping& c) {
  if (c.cap.size() < 3) return;
  Vec3 center = Vec3::Zero();
  for (const int v : c.cap) center += c.kept[v] / static_cast<double>(c.cap.size());
  const Tangents along(plane.normal);
  c.order.clear();
  for (const int v : c.cap) {
    const Vec3 arm = c.kept[v] - center;
    c.order.emplace_back(std::atan2(along.y.dot(arm), along.x.dot(arm)), v);
  }
  std::sort(c.order.begin(), c.order.end());
  faces_.push_back({plane, static_cast<int>(c.loops.size()), static_cast<int>(c.order.size())});
  for (const auto& [angle, v] : c.order) c.loops.push_back(v);
}

void ConvexCell::clip(const Plane& plane) {
  if (empty()) return;
  static thread_local Clipping c;  // kept for its memory: cells are cut by hundreds of planes
  const auto [any_in, any_out] = measure_heights(plane, c);
  if (!any_out) return;
  if (!any_in) {
    faces_.clear();
    vertices_.clear();
    return;
  }

  // Old vertices that stay get new indices as they are met; each cut edge gets one new vertex.
  c.kept.clear();
  c.renumbered.assign(vertices_.size(), -1);
  c.cuts.clear();
  c.cap.clear();
  const auto keep = [&](int v) {
    if (c.renumbered[v] < 0) {
      c.renumbered[v] = static_cast<int>(c.kept.size());
      c.kept.push_back(vertices_[v]);
      if (c.height[v] == 0.0) c.cap.push_back(c.renumbered[v]);
    }
    return c.renumbered[v];
  };
  const auto cut = [&](int u, int v) {
    const auto [first, second] = std::minmax(u, v);
    for (const Clipping::Cut& known : c.cuts) {
      if (known.first == first && known.second == second) return known.vertex;
    }
    const int vertex = static_cast<int>(c.kept.size());
    const double t = c.height[first] / (c.height[first] - c.height[second]);
    c.kept.push_back(vertices_[first] + t * (vertices_[second] - vertices_[first]));
    c.cap.push_back(vertex);
    c.cuts.push_back({first, second, vertex});
    return vertex;
  };
  c.loops.clear();
  std::size_t stay = 0;
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    const Face face = faces_[f];  // its place may be taken by itself or one before it
    const int *begin = loops_.data() + face.first, *end = begin + face.count;
    if (std::none_of(begin, end, [&](int v) { return c.height[v] < 0.0; })) continue;
    const int first = static_cast<int>(c.loops.size());
    for (const int* at = begin; at != end; ++at) {
      const int u = *at, v = at + 1 == end ? *begin : at[1];
      if (c.height[u] <= 0.0) c.loops.push_back(keep(u));
      if (c.height[u] * c.height[v] < 0.0) c.loops.push_back(cut(u, v));
    }
    const int count = static_cast<int>(c.loops.size()) - first;
    if (count < 3)
      c.loops.resize(static_cast<std::size_t>(first));
    else
      faces_[stay++] = {face.plane, first, count};
  }
  faces_.resize(stay);

  add_cap(plane, c);
  std::swap(vertices_, c.kept);
  std::swap(loops_, c.loops);
  BIN_SCENES_ASSERT(each_is(loops_, [&](int v) { return v >= 0 && v < static_cast<int>(vertices_.size()); }));
}

std::vector<ConvexCell::Edge> ConvexCell::edges(const std::vector<char>& wanted) const {
  struct Side {
    int u, v, face;
  };
  static thread_local std::vector<char> marked;  // vertices of wanted faces
  static thread_local std::vector<Side> sides;   // between these; both kept for their memory
  marked.assign(vertices_.size(), 0);
  for (std::size_t f = 0; f < faces_.size(); ++f)
    for (int i = 0; wanted[f] && i < faces_[f].count; ++i) marked[loops_[faces_[f].first + i]] = 1;
  sides.clear();
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    const int *loop = loops_.data() + faces_[f].first, count = faces_[f].count;
    for (int i = 0; i < count; ++i) {
      const auto [u, v] = std::minmax(loop[i], loop[i + 1 == count ? 0 : i + 1]);
      if (marked[u] && marked[v]) sides.push_back({u, v, static_cast<int>(f)});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& s, const Side& t) {
    return std::array{s.u, s.v, s.face} < std::array{t.u, t.v, t.face};
  });
  std::vector<Edge> edges;
  for (std::size_t i = 1; i < sides.size(); ++i) {
    const Side &s = sides[i - 1], &t = sides[i];
    if (s.u != t.u || s.v != t.v) continue;
    edges.push_back({s.u, {s.face, t.face}, faces_[s.face].plane.normal.cross(faces_[t.face].plane.normal)});
  }
  return edges;
}

const Vec3& ConvexCell::lowest(const Vec3& direction) const {
  std::size_t best = 0;
  double low = direction.dot(vertices_[0]);
  for (std::size_t v = 1; v < vertices_.size(); ++v) {
    const double d = direction.dot(vertices_[v]);
    if (d < low) {
      low = d;
      best = v;
    }
  }
  return vertices_[best];
}

namespace {

/// An edge with the least depth that any pair it takes part in can have.
struct BoundedEdge {
  ConvexCell::Edge edge;
  double bound;
};

std::vector<BoundedEdge> bounded_edges(const ConvexCell& cell, const std::vector<double>& beneath, double limit) {
  // A normal of an edge is a combination of its faces' normals with weights that sum to at least one.
  std::vector<char> near;
  for (const double depth : beneath) near.push_back(depth < limit);
  std::vector<BoundedEdge> edges;
  for (const ConvexCell::Edge& edge : cell.edges(near)) {
    const double bound = std::min(beneath[edge.face[0]], beneath[edge.face[1]]);
    if (bound < limit) edges.push_back({edge, bound});
  }
  std::sort(edges.begin(), edges.end(), [](const BoundedEdge& s, const BoundedEdge& t) {
    return s.bound != t.bound
               ? s.bound < t.bound
               : std::make_pair(s.edge.face[0], s.edge.face[1]) < std::make_pair(t.edge.face[0], t.edge.face[1]);
  });
  return edges;
}

}  // namespace

Separation separation(const ConvexCell& a, const ConvexCell& b, const Vec3& common, double slack, double enough) {
  if (a.empty() || b.empty()) return {};
  Separation best;
  best.depth = std::numeric_limits<double>::infinity();

  // Faces of either against the lowest point of the other.
  std::array<std::vector<double>, 2> beneath;  // how far `common` lies below each face, at least
  for (int side = 0; side < 2; ++side) {
    const ConvexCell &one = side ? b : a, &other = side ? a : b;
    for (const ConvexCell::Face& face : one.faces()) {
      const double bound = std::max(0.0, -face.plane.above(common) - slack);
      beneath[side].push_back(bound);
      if (bound >= best.depth) continue;
      const Vec3& low = other.lowest(face.plane.normal);
      const double depth = -face.plane.above(low);
      if (depth >= best.depth) continue;
      best = {depth, side ? Vec3(-face.plane.normal) : face.plane.normal, low};
      if (depth <= enough) return best;
    }
  }

  // Pairs of edges that make a face of the Minkowski difference.
  const std::vector<BoundedEdge> of_a = bounded_edges(a, beneath[0], best.depth);
  const std::vector<BoundedEdge> of_b = bounded_edges(b, beneath[1], best.depth);
  for (const auto& [ea, bound_a] : of_a) {
    if (bound_a >= best.depth) break;
    const Vec3 &a1 = a.faces()[ea.face[0]].plane.normal, &a2 = a.faces()[ea.face[1]].plane.normal;
    for (const auto& [eb, bound_b] : of_b) {
      if (bound_a + bound_b >= best.depth) break;
      const Vec3 &b1 = b.faces()[eb.face[0]].plane.normal, &b2 = b.faces()[eb.face[1]].plane.normal;
      const double b1_side = -b1.dot(ea.fan), b2_side = -b2.dot(ea.fan);
      if (b1_side * b2_side >= 0.0) continue;
      const double a1_side = a1.dot(eb.fan), a2_side = a2.dot(eb.fan);
      if (a1_side * a2_side >= 0.0 || b1_side * a2_side <= 0.0) continue;
      Vec3 normal = ea.fan.cross(eb.fan);
      const double length = normal.norm();
      if (length <= 1e-9 * ea.fan.norm() * eb.fan.norm()) continue;  // parallel: the faces have judged it
      normal *= (normal.dot(a1 + a2) < 0.0 ? -1.0 : 1.0) / length;
      const Vec3 &pa = a.vertices()[ea.vertex], &pb = b.vertices()[eb.vertex];
      const double depth = normal.dot(pa - pb);
      if (depth >= best.depth) continue;
      best = {depth, normal, pa};
      if (depth <= enough) return best;
    }
  }
  return best;
}

}  // namespace bin_scenes
