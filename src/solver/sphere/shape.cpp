#include "solver/sphere/shape.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

namespace bin_scenes::sphere {

namespace {

/// A sharp convex edge of the mesh.
struct SharpEdge {
  std::uint32_t a, b;
  Cone cone;
};

struct SharpEdges {
  std::vector<SharpEdge> convex;
  std::set<std::uint32_t> saddles;  ///< vertices at which a concave edge ends too
};

/// Directions between the normals of both faces of an edge, as bounds: across the edge into each face, and along it.
Cone edge_cone(const Mesh& mesh, std::uint32_t a, std::uint32_t b, const std::vector<std::size_t>& faces) {
  Cone cone;
  const Vec3 along = (mesh.vertices[b] - mesh.vertices[a]).normalized();
  for (const std::size_t face : faces) {
    const Triangle& t = mesh.triangles[face];
    const Vec3 middle = (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3.0;
    Vec3 into = middle - mesh.vertices[a];
    into -= into.dot(along) * along;
    if (into.norm() < 1e-9 * (mesh.vertices[b] - mesh.vertices[a]).norm()) return Cone{};  // a sliver tells nothing
    cone.bound[cone.bounds++] = into.normalized().cast<float>();
  }
  cone.bound[cone.bounds++] = along.cast<float>();
  cone.bound[cone.bounds++] = -along.cast<float>();
  return cone;
}

/// Edges over which the surface bends outwards by more than `angle`. Concave edges cannot touch first.
SharpEdges sharp_edges(const Mesh& mesh, double angle) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::size_t>> sides;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int e = 0; e < 3; ++e) {
      const std::uint32_t a = mesh.triangles[t][e], b = mesh.triangles[t][(e + 1) % 3];
      sides[std::minmax(a, b)].push_back(t);
    }
  SharpEdges sharp;
  for (const auto& [ends, faces] : sides) {
    if (faces.size() != 2) {
      sharp.convex.push_back({ends.first, ends.second, Cone{}});
      continue;
    }
    const Vec3 n0 = mesh.area_vector(faces[0]).normalized(), n1 = mesh.area_vector(faces[1]).normalized();
    if (n0.dot(n1) > std::cos(angle)) continue;
    // Convex: the far corner of one face lies behind the other face.
    const auto& other = mesh.triangles[faces[1]];
    std::uint32_t far = other[0];
    for (const std::uint32_t v : other)
      if (v != ends.first && v != ends.second) far = v;
    if (n0.dot(mesh.vertices[far] - mesh.vertices[ends.first]) < 0) {
      sharp.convex.push_back({ends.first, ends.second, edge_cone(mesh, ends.first, ends.second, faces)});
    } else {
      sharp.saddles.insert(ends.first);
      sharp.saddles.insert(ends.second);
    }
  }
  return sharp;
}

/// Nodes and edge pieces before they are put in cluster order.
struct Draft {
  std::vector<Vec3> nodes;
  std::vector<Cone> cones;
  std::vector<Edge> edges;

  std::uint32_t add(const Vec3& node, const Cone& cone) {
    nodes.push_back(node);
    cones.push_back(cone);
    return static_cast<std::uint32_t>(nodes.size() - 1);
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

/// Sharp edges cut in pieces no longer than `spacing`; corners appear once.
Draft edge_draft(const Mesh& mesh, const SharpEdges& sharp, double spacing) {
  Draft draft;
  std::map<std::uint32_t, std::vector<const SharpEdge*>> around;
  for (const SharpEdge& edge : sharp.convex) {
    around[edge.a].push_back(&edge);
    around[edge.b].push_back(&edge);
  }
  std::map<std::uint32_t, std::uint32_t> corner;
  for (const auto& [vertex, edges] : around)
    corner[vertex] =
        draft.add(mesh.vertices[vertex], sharp.saddles.count(vertex) ? Cone{} : corner_cone(mesh, vertex, edges));
  for (const SharpEdge& edge : sharp.convex) {
    const Vec3 a = mesh.vertices[edge.a], b = mesh.vertices[edge.b];
    const int pieces = std::max(1, static_cast<int>(std::ceil((b - a).norm() / spacing)));
    std::uint32_t last = corner[edge.a];
    for (int i = 1; i <= pieces; ++i) {
      const std::uint32_t next =
          i == pieces ? corner[edge.b] : draft.add(a + (b - a) * (static_cast<double>(i) / pieces), edge.cone);
      draft.edges.push_back({last, next, 0, edge.cone});
      last = next;
    }
  }
  return draft;
}

/// Cone of a point on a face: as far around its normal as the normals of its neighbours on the same face lean.
Cone face_cone(const SurfaceSample& sample, const std::vector<SurfaceSample>& all, double sharp_angle) {
  const double near = 2.0 * sample.spacing, least = std::cos(sharp_angle);
  double most = 1;
  for (const SurfaceSample& other : all) {
    if ((other.point - sample.point).squaredNorm() > near * near) continue;
    const double lean = other.normal.dot(sample.normal);
    if (lean > least) most = std::min(most, lean);
  }
  Cone cone;
  cone.axis = sample.normal.cast<float>();
  cone.spread = static_cast<float>(std::acos(std::min(1.0, most)));
  return cone;
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

Samples clustered(const Draft& draft, const Vec3& center, double spacing) {
  std::vector<std::uint32_t> order(draft.nodes.size());
  std::iota(order.begin(), order.end(), 0u);
  kd_order(draft.nodes, order, 0, order.size());
  std::vector<std::uint32_t> place(order.size());
  Samples samples;
  samples.spacing = static_cast<float>(spacing);
  for (std::size_t i = 0; i < order.size(); ++i) {
    place[order[i]] = static_cast<std::uint32_t>(i);
    samples.nodes.push_back((draft.nodes[order[i]] - center).cast<float>());
    samples.cones.push_back(draft.cones[order[i]]);
  }
  for (Edge e : draft.edges) {
    Edge placed{place[e.a], place[e.b], 0, e.cone};
    if (placed.a > placed.b) std::swap(placed.a, placed.b);
    samples.edges.push_back(placed);
  }
  std::sort(samples.edges.begin(), samples.edges.end(),
            [](const Edge& x, const Edge& y) { return std::make_pair(x.a, x.b) < std::make_pair(y.a, y.b); });
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

double total_length(const Mesh& mesh, const SharpEdges& sharp) {
  double length = 0;
  for (const SharpEdge& e : sharp.convex) length += (mesh.vertices[e.a] - mesh.vertices[e.b]).norm();
  return length;
}

/// Radius of the ball a tessellated ball stands for: all its vertices lie on it and no face cuts deep below; else 0.
float ball_radius(const PartModel& part) {
  const Mesh& mesh = part.mesh();
  const Vec3& center = part.mass().center;
  const double radius = part.radius();
  for (const Vec3& v : mesh.vertices)
    if ((v - center).norm() < 0.999 * radius) return 0;
  for (const Triangle& t : mesh.triangles)
    if (((mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3 - center).norm() < 0.97 * radius)
      return 0;
  return static_cast<float>(radius);
}

/// A ball needs one node, its centre.
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

/// About `count` nodes: half of them on sharp edges where there are such, the others on faces.
Samples make_samples(const PartModel& part, int count, double sharp_angle) {
  const Mesh& mesh = part.mesh();
  SharpEdges sharp = sharp_edges(mesh, sharp_angle);
  // A finely tessellated curve has many slightly bent edges: keep the sharpest until the nodes suffice.
  // Where the nodes would stand too far apart to stand for them, they belong to a curved face.
  constexpr double longest_piece = 0.03, edge_share = 0.5;  // of d, of the nodes
  while ((sharp.convex.size() > static_cast<std::size_t>(2 * count) ||
          total_length(mesh, sharp) > edge_share * count * longest_piece * part.diagonal()) &&
         sharp_angle < 0.8)
    sharp = sharp_edges(mesh, sharp_angle *= 1.3);
  const double spacing = std::max(total_length(mesh, sharp) / (edge_share * count), 0.004 * part.diagonal());
  Draft draft = edge_draft(mesh, sharp, spacing);
  // Some of these fall on edges that have their nodes.
  const int faces = 2 * std::max(count / 2, count - static_cast<int>(draft.nodes.size()));
  // Face nodes, but for those that stand on a sharp edge already covered.
  std::vector<SurfaceSample> on_faces;
  for (const SurfaceSample& sample : part.samples({faces, sharp_angle}).samples) {
    const auto near = [&](const Vec3& node) { return (node - sample.point).norm() < 0.5 * spacing; };
    if (std::none_of(draft.nodes.begin(), draft.nodes.end(), near)) on_faces.push_back(sample);
  }
  for (const SurfaceSample& sample : on_faces) draft.add(sample.point, face_cone(sample, on_faces, sharp_angle));
  Samples made = clustered(draft, part.mass().center, spacing);
  for (const SurfaceSample& sample : on_faces)
    made.face_spacing += static_cast<float>(sample.spacing / on_faces.size());
  for (const Cone& cone : made.cones)
    if (!cone.axis.isZero()) made.sag = std::max(made.sag, 0.25f * std::min(cone.spread, 0.6f) * made.face_spacing);
  return made;
}

constexpr double cells_through = 1.5;  ///< of the field, through the thinnest part: two nodes see its inside

}  // namespace

Shape make_shape(const PartModel& part, int coarse, int fine, double field_cell) {
  Shape shape;
  const MassProperties& mass = part.mass();
  shape.center = mass.center.cast<float>();
  shape.diagonal = static_cast<float>(part.diagonal());
  shape.radius = static_cast<float>(part.radius());
  shape.thickness = static_cast<float>(2.0 * mass.volume / mass.area);
  shape.volume = static_cast<float>(mass.volume);
  shape.unit_inertia = (mass.inertia / mass.volume).cast<float>();
  const Aabb box = part.mesh().bounds();
  shape.box_center = (box.center() - mass.center).cast<float>();
  shape.box_half = (0.5 * box.size()).cast<float>();

  shape.field.ball = ball_radius(part);
  if (shape.field.ball > 0) {
    shape.coarse = shape.fine = ball_samples(shape.field.ball);
    return shape;
  }
  // A sheet thinner than a cell has no inside: others would pass through it.
  if (shape.thickness > 0) field_cell = std::min(field_cell, shape.thickness / part.diagonal() / cells_through);
  const DistanceField& field = part.field({field_cell});
  shape.field.origin = (field.origin - mass.center).cast<float>();
  shape.field.cell = static_cast<float>(field.cell);
  shape.field.inverse_cell = 1.0f / shape.field.cell;
  shape.field.nx = field.nodes[0];
  shape.field.ny = field.nodes[1];
  shape.field.nz = field.nodes[2];
  shape.field.values = field.values.data();
  const Vec3 pad = (box.lower - field.origin).cwiseMax(0.0);
  shape.field.padding = static_cast<float>(pad.minCoeff());

  shape.coarse = make_samples(part, coarse, 0.5);
  shape.fine = make_samples(part, fine, 0.15);
  return shape;
}

}  // namespace bin_scenes::sphere
