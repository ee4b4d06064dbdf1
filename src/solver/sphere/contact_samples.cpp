#include "solver/sphere/contact_samples.hpp"

#include "part/part_bytes.hpp"
#include "solver/sphere/point_grid.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace bin_scenes::sphere {

namespace {

/// Nodes and edge pieces before they are put in cluster order.
struct Draft {
  std::vector<Vec3> nodes;
  std::vector<Cone> cones;
  std::vector<Edge> edges;
  std::vector<std::uint32_t> at_vertex;  ///< by vertex: the node that lies there, or `none`

  static constexpr std::uint32_t none = 0xffffffffu;

  std::uint32_t add(const Vec3& node, const Cone& cone) {
    nodes.push_back(node);
    cones.push_back(cone);
    return static_cast<std::uint32_t>(nodes.size() - 1);
  }
  /// Between two vertices that have nodes, in pieces no longer than `spacing`.
  void add_edge(const Mesh& mesh, std::uint32_t from, std::uint32_t to, const Cone& cone, bool sharp, double spacing) {
    const Vec3 a = mesh.vertices[from], b = mesh.vertices[to];
    const int pieces = std::max(1, static_cast<int>(std::ceil((b - a).norm() / spacing)));
    std::uint32_t last = at_vertex[from];
    for (int i = 1; i <= pieces; ++i) {
      const std::uint32_t next =
          i == pieces ? at_vertex[to] : add(a + (b - a) * (static_cast<double>(i) / pieces), cone);
      edges.push_back({last, next, 0, sharp, cone});
      last = next;
    }
  }
};

/// Cone of a vertex from the sharp edges that end there: three or more bound it themselves, two with their faces.
Cone corner_cone(const Mesh& mesh, std::uint32_t vertex, const std::vector<const SharpEdge*>& edges) {
  Cone cone;
  const auto add = [&](const Vec3f& bound) {
    if (cone.bounds < Cone::max_bounds) cone.bound[cone.bounds++] = bound;
  };
  if (edges.size() < 2 || edges.size() > static_cast<std::size_t>(Cone::max_bounds)) return cone;
  for (const SharpEdge* edge : edges) {
    if (edge->cone.bounds == 0) return Cone{};
    const std::uint32_t other = edge->a == vertex ? edge->b : edge->a;
    add((mesh.vertices[other] - mesh.vertices[vertex]).normalized().cast<float>());
  }
  if (edges.size() == 2)
    for (const SharpEdge* edge : edges)
      for (int i = 0; i < 2; ++i) add(edge->cone.bound[i]);
  return cone;
}

/// Cone of a vertex where a concave edge ends, too: away from all faces of its sharp edges.
Cone saddle_cone(const std::vector<const SharpEdge*>& edges) {
  Cone cone;
  if (2 * edges.size() > static_cast<std::size_t>(Cone::max_bounds)) return cone;
  for (const SharpEdge* edge : edges) {
    if (edge->cone.bounds == 0) return Cone{};
    for (int i = 0; i < 2; ++i) cone.bound[cone.bounds++] = edge->cone.bound[i];
  }
  return cone;
}

/// Sharp edges cut in pieces no longer than `spacing`; corners appear once.
Draft edge_draft(const Mesh& mesh, const SharpEdges& sharp, double spacing) {
  Draft draft;
  draft.nodes.reserve(2 * sharp.convex.size());
  draft.cones.reserve(2 * sharp.convex.size());
  draft.edges.reserve(2 * sharp.convex.size());
  // The edges at each vertex, one vertex after the other.
  std::vector<std::size_t> last(mesh.vertices.size() + 1, 0);
  for (const SharpEdge& edge : sharp.convex)
    for (const std::uint32_t v : {edge.a, edge.b}) ++last[v + 1];
  std::partial_sum(last.begin(), last.end(), last.begin());
  std::vector<const SharpEdge*> around(last.back());
  for (const SharpEdge& edge : sharp.convex)
    for (const std::uint32_t v : {edge.a, edge.b}) around[last[v]++] = &edge;
  draft.at_vertex.assign(mesh.vertices.size(), Draft::none);
  std::vector<const SharpEdge*> edges;
  std::size_t first = 0;
  for (std::uint32_t v = 0; v < mesh.vertices.size(); first = last[v++]) {
    if (first == last[v]) continue;
    edges.assign(around.begin() + first, around.begin() + last[v]);
    draft.at_vertex[v] =
        draft.add(mesh.vertices[v], sharp.saddles[v] ? saddle_cone(edges) : corner_cone(mesh, v, edges));
  }
  for (const SharpEdge& edge : sharp.convex)
    draft.add_edge(mesh, edge.a, edge.b, edge.cone, edge.cone.bounds > 0, spacing);
  return draft;
}

/// Cones of points on faces: as far around the normal as the normals of neighbours on the same face lean.
std::vector<Cone> face_cones(const std::vector<SurfaceSample>& samples, double sharp_angle) {
  std::vector<Vec3> points;
  double spacing = 0;
  for (const SurfaceSample& sample : samples) {
    points.push_back(sample.point);
    spacing += sample.spacing / static_cast<double>(samples.size());
  }
  const PointGrid grid(points, 2.0 * spacing);
  const double least = std::cos(sharp_angle);
  std::vector<Cone> cones;
  for (const SurfaceSample& sample : samples) {
    double most = 1;
    grid.any_within(sample.point, 2.0 * sample.spacing, [&](std::size_t i) {
      const double lean = samples[i].normal.dot(sample.normal);
      if (lean > least) most = std::min(most, lean);
      return false;
    });
    Cone cone;
    cone.axis = sample.normal.cast<float>();
    cone.spread = static_cast<float>(std::acos(std::min(1.0, most)));
    cones.push_back(cone);
  }
  return cones;
}

/// Normal cone of a vertex from all its neighbours; all directions if they are too many.
Cone vertex_cone(const Mesh& mesh, std::uint32_t vertex, const std::vector<std::uint32_t>& neighbours) {
  Cone cone;
  if (neighbours.size() > static_cast<std::size_t>(Cone::max_bounds)) return cone;
  for (const std::uint32_t other : neighbours)
    cone.bound[cone.bounds++] = (mesh.vertices[other] - mesh.vertices[vertex]).normalized().cast<float>();
  return cone;
}

/// By how much (m) a curved face may rise above a node of it, as far as the node slides along it.
double bulge(const Cone& cone, double face_spacing) {
  return 0.25 * std::min(cone.spread, 0.6f) * face_spacing;
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
      constexpr double slid = 0.7;  // of the longest way of a node along its face: it may end early
      const Vec3 way = x - draft_.nodes[i];
      const Vec3f& axis = draft_.cones[i].axis;
      const double height = way.dot(out);
      return height <= most_ || (height <= bulge(draft_.cones[i], face_spacing_) && way.norm() < slid * face_spacing_ &&
                                 axis.cast<double>().dot(out) > 0.5);
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

/// Adds the vertices that stick out between the nodes by more than `most`. Where the folds of a bend lie about the
/// angle that makes an edge, some of them are edges, and what lies between those counts as covered by their nodes,
/// which do not slide: nothing felt the crown of a handle.
void add_missed_vertices(const Mesh& mesh, double face_spacing, double most, Draft& draft) {
  std::vector<std::vector<std::uint32_t>> neighbours(mesh.vertices.size());
  std::vector<Vec3> normals(mesh.vertices.size(), Vec3::Zero());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t v = mesh.triangles[t][i];
      if (draft.at_vertex[v] != Draft::none) continue;
      neighbours[v].push_back(mesh.triangles[t][(i + 1) % 3]);  // of a closed mesh these are all
      normals[v] += mesh.area_vector(t).normalized();
    }
  Feeling nodes(draft, face_spacing, most);
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    if (draft.at_vertex[v] != Draft::none) continue;
    const Vec3 &x = mesh.vertices[v], out = normals[v].normalized();
    const auto below = [&](std::uint32_t other) { return out.dot(mesh.vertices[other] - x) <= 0; };
    if (!std::all_of(neighbours[v].begin(), neighbours[v].end(), below)) continue;  // it cannot touch first
    if (!nodes.feels(x, out)) draft.at_vertex[v] = draft.add(x, vertex_cone(mesh, v, neighbours[v]));
  }
}

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

/// Adds the long edges of the mesh that stick out between the nodes by more than `most`: the strips of which an edge
/// that is rounded is made are too narrow for nodes of faces, bend too little for sharp edges, and their vertices lie
/// at their ends.
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

/// Halves [first, last) of the order along the longest side of its bounds until a run fits a cluster, so that each
/// run of cluster_size nodes is compact.
void kd_order(const std::vector<Vec3>& nodes, std::vector<std::uint32_t>& order, std::size_t first, std::size_t last) {
  if (last - first <= static_cast<std::size_t>(cluster_size)) return;
  Aabb box;
  for (std::size_t i = first; i < last; ++i) box.extend(nodes[order[i]]);
  int axis = 0;
  box.size().maxCoeff(&axis);
  std::size_t half = (last - first) / 2;
  half = std::max<std::size_t>(cluster_size, (half + cluster_size - 1) / cluster_size * cluster_size);
  std::nth_element(order.begin() + first, order.begin() + first + half, order.begin() + last,
                   [&](std::uint32_t a, std::uint32_t b) {
                     return std::make_pair(nodes[a][axis], a) < std::make_pair(nodes[b][axis], b);
                   });
  kd_order(nodes, order, first, first + half);
  kd_order(nodes, order, first + half, last);
}

Ball ball_around(const std::vector<Vec3f>& points) {
  Vec3f lower = points.front(), upper = points.front();
  for (const Vec3f& p : points) {
    lower = lower.cwiseMin(p);
    upper = upper.cwiseMax(p);
  }
  Ball ball{0.5f * (lower + upper), 0};
  for (const Vec3f& p : points) ball.radius = std::max(ball.radius, (p - ball.center).norm());
  return ball;
}

/// Copies by component; the last point fills up what is left of a bunch.
void lay_out(Samples& samples) {
  samples.node_points.resize(samples.clusters.size());
  for (std::size_t i = 0; i < samples.node_points.size() * cluster_size; ++i)
    samples.node_points[i / cluster_size].set(i % cluster_size, samples.nodes[std::min(i, samples.nodes.size() - 1)]);
  samples.cluster_points.resize(samples.groups.size());
  for (std::size_t i = 0; i < samples.cluster_points.size() * group_size; ++i)
    samples.cluster_points[i / group_size].set(i % group_size,
                                               samples.clusters[std::min(i, samples.clusters.size() - 1)].center);
}

Samples clustered(Draft draft, const Vec3& center, double spacing) {
  std::vector<std::uint32_t> order(draft.nodes.size());
  std::iota(order.begin(), order.end(), 0u);
  kd_order(draft.nodes, order, 0, order.size());
  std::vector<std::uint32_t> place(order.size());
  Samples samples;
  samples.spacing = static_cast<float>(spacing);
  samples.nodes.reserve(order.size());
  samples.cones.reserve(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    place[order[i]] = static_cast<std::uint32_t>(i);
    samples.nodes.push_back((draft.nodes[order[i]] - center).cast<float>());
    samples.cones.push_back(draft.cones[order[i]]);
  }
  struct EdgeAt {
    std::uint32_t a, b;
    std::size_t at;
  };
  std::vector<EdgeAt> edges;  // small ones to sort: cones make an edge big
  edges.reserve(draft.edges.size());
  for (std::size_t i = 0; i < draft.edges.size(); ++i) {
    const auto [a, b] = std::minmax(place[draft.edges[i].a], place[draft.edges[i].b]);
    edges.push_back({a, b, i});
  }
  std::sort(edges.begin(), edges.end(),
            [](const EdgeAt& x, const EdgeAt& y) { return std::tie(x.a, x.b, x.at) < std::tie(y.a, y.b, y.at); });
  samples.edges.reserve(edges.size());
  for (const auto& [a, b, at] : edges) samples.edges.push_back({a, b, 0, draft.edges[at].sharp, draft.edges[at].cone});
  const std::size_t clusters = (samples.nodes.size() + cluster_size - 1) / cluster_size;
  for (Edge& edge : samples.edges) edge.length = (samples.nodes[edge.a] - samples.nodes[edge.b]).norm();
  std::size_t e = 0;
  samples.first_edge.push_back(0);
  for (std::size_t c = 0; c < clusters; ++c) {
    const std::size_t first = c * cluster_size, last = std::min(samples.nodes.size(), first + cluster_size);
    std::vector<Vec3f> points(samples.nodes.begin() + first, samples.nodes.begin() + last);
    for (; e < samples.edges.size() && samples.edges[e].a < last; ++e)
      points.push_back(samples.nodes[samples.edges[e].b]);
    samples.first_edge.push_back(static_cast<std::uint32_t>(e));
    samples.clusters.push_back(ball_around(points));
  }
  for (std::size_t g = 0; g < clusters; g += group_size) {
    Vec3f lower = samples.clusters[g].center, upper = lower;
    for (std::size_t c = g; c < std::min(clusters, g + group_size); ++c) {
      const Ball& b = samples.clusters[c];
      lower = lower.cwiseMin(b.center - Vec3f::Constant(b.radius));
      upper = upper.cwiseMax(b.center + Vec3f::Constant(b.radius));
    }
    Ball ball{0.5f * (lower + upper), 0};
    for (std::size_t c = g; c < std::min(clusters, g + group_size); ++c)
      ball.radius =
          std::max(ball.radius, (samples.clusters[c].center - ball.center).norm() + samples.clusters[c].radius);
    samples.groups.push_back(ball);
  }
  lay_out(samples);
  return samples;
}

}  // namespace

Samples ball_samples(float radius) {
  Samples samples;
  samples.nodes = {Vec3f::Zero()};
  samples.cones = {Cone{}};
  samples.clusters = samples.groups = {{Vec3f::Zero(), 0}};
  samples.first_edge = {0, 0};
  samples.radius = samples.spacing = radius;
  lay_out(samples);
  return samples;
}

Samples make_samples(const PartModel& part, const std::vector<Fold>& folds, int count, double sharp_angle,
                     double ridge) {
  const Mesh& mesh = part.mesh();
  // A finely tessellated curve has many slightly bent edges: keep the sharpest until the nodes suffice.
  constexpr double most_missed = 5e-4, most_off = 2e-4;  // of d
  constexpr double sharpest = 0.75;                      // rad: a chamfer of 45 degrees has edges in any case
  const double most_length = edge_share * count * longest_edge_piece * part.diagonal();
  SharpEdges sharp;
  for (;; sharp_angle = std::min(1.3 * sharp_angle, sharpest)) {
    const bool last = sharp_angle >= sharpest;
    if (!last && sharp_length(mesh, folds, sharp_angle) > most_length) continue;
    sharp = straightened(mesh, sharp_edges(mesh, folds, sharp_angle), most_off * part.diagonal());
    if (last || sharp.convex.size() <= static_cast<std::size_t>(2 * count)) break;
  }
  const double edge_length = sharp_length(mesh, folds, sharp_angle);
  const double spacing = std::max(edge_length / (edge_share * count), 0.004 * part.diagonal());
  Draft draft = edge_draft(mesh, sharp, spacing);
  // Some of these fall on edges that have their nodes.
  const int faces = 2 * std::max(count / 2, count - static_cast<int>(draft.nodes.size()));
  // Face nodes, but for those that stand on a sharp edge already covered: half a piece away at most, also where it was
  // straightened. Their normals are means of two faces.
  const double half_piece = 0.5 * spacing + most_off * part.diagonal();
  const PointGrid on_edges(draft.nodes, half_piece);
  std::vector<SurfaceSample> on_faces;
  for (const SurfaceSample& sample : part.samples({faces, sharp_angle}).samples)
    if (!on_edges.any_within(sample.point, half_piece, [](std::size_t) { return true; })) on_faces.push_back(sample);
  const std::vector<Cone> cones = face_cones(on_faces, sharp_angle);
  for (std::size_t i = 0; i < on_faces.size(); ++i) draft.add(on_faces[i].point, cones[i]);
  double face_spacing = 0;
  for (const SurfaceSample& sample : on_faces) face_spacing += sample.spacing / static_cast<double>(on_faces.size());
  const double reach = face_spacing > 0 ? face_spacing : spacing;
  add_missed_vertices(mesh, reach, most_missed * part.diagonal(), draft);
  add_missed_ridges(mesh, reach, spacing, ridge * part.diagonal(), draft);
  Samples made = clustered(std::move(draft), part.mass().center, spacing);
  made.face_spacing = static_cast<float>(face_spacing);
  for (const Cone& cone : made.cones)
    if (!cone.axis.isZero()) made.sag = std::max(made.sag, static_cast<float>(bulge(cone, face_spacing)));
  return made;
}

namespace {

/// Each list that clustered() makes but those of lay_out(), in one order for both directions.
template <class AnySamples, class Each>
void for_each_list(AnySamples& samples, Each&& each) {
  each(samples.nodes);
  each(samples.cones);
  each(samples.edges);
  each(samples.clusters);
  each(samples.first_edge);
  each(samples.groups);
}

template <class AnySamples, class Each>
void for_each_number(AnySamples& samples, Each&& each) {
  each(samples.spacing);
  each(samples.face_spacing);
  each(samples.sag);
  each(samples.radius);
}

}  // namespace

void put(ByteWriter& out, const Samples& samples) {
  for_each_list(samples, [&](const auto& list) {
    out.put(static_cast<std::uint64_t>(list.size()));
    out.put_raw(list.data(), list.size() * sizeof list[0]);
  });
  for_each_number(samples, [&](float number) { out.put(number); });
}

void get(ByteReader& in, Samples& samples) {
  for_each_list(samples, [&](auto& list) {
    list.resize(in.count(sizeof list[0]));
    in.get_raw(list.data(), list.size() * sizeof list[0]);
  });
  for_each_number(samples, [&](float& number) { in.get(number); });
  if (in.ok()) lay_out(samples);
}

}  // namespace bin_scenes::sphere
