#include "solver/sphere/shape.hpp"

#include <algorithm>
#include <map>
#include <numeric>

namespace bin_scenes::sphere {

namespace {

/// Corner values around a point of the grid, and where in the cell it lies.
struct Cell {
  float c[8];
  float u, v, w;
  float outside;  ///< way from the point to the grid (m)
};

inline Cell locate(const Field& f, const Vec3f& point) {
  const float gx = (point.x() - f.origin.x()) * f.inverse_cell;
  const float gy = (point.y() - f.origin.y()) * f.inverse_cell;
  const float gz = (point.z() - f.origin.z()) * f.inverse_cell;
  const float x = std::min(std::max(gx, 0.0f), static_cast<float>(f.nx) - 1.001f);
  const float y = std::min(std::max(gy, 0.0f), static_cast<float>(f.ny) - 1.001f);
  const float z = std::min(std::max(gz, 0.0f), static_cast<float>(f.nz) - 1.001f);
  const int i = static_cast<int>(x), j = static_cast<int>(y), k = static_cast<int>(z);
  const std::size_t row = static_cast<std::size_t>(f.nx), slice = row * f.ny;
  const float* p = f.values + i + row * j + slice * k;
  Cell cell;
  cell.c[0] = p[0];
  cell.c[1] = p[1];
  cell.c[2] = p[row];
  cell.c[3] = p[row + 1];
  cell.c[4] = p[slice];
  cell.c[5] = p[slice + 1];
  cell.c[6] = p[slice + row];
  cell.c[7] = p[slice + row + 1];
  cell.u = x - i;
  cell.v = y - j;
  cell.w = z - k;
  const float dx = gx - x, dy = gy - y, dz = gz - z;
  const float out = dx * dx + dy * dy + dz * dz;
  cell.outside = out > 1e-4f ? std::sqrt(out) * f.cell : 0.0f;
  return cell;
}

inline float mix(float a, float b, float t) {
  return a + (b - a) * t;
}

inline float value(const Cell& c) {
  const float x0 = mix(c.c[0], c.c[1], c.u), x1 = mix(c.c[2], c.c[3], c.u);
  const float x2 = mix(c.c[4], c.c[5], c.u), x3 = mix(c.c[6], c.c[7], c.u);
  return mix(mix(x0, x1, c.v), mix(x2, x3, c.v), c.w);
}

}  // namespace

float Field::sample(const Vec3f& point) const {
  if (ball > 0) return point.norm() - ball;
  const Cell c = locate(*this, point);
  return c.outside > 0 ? std::max(value(c), c.outside + padding) : value(c);
}

float Field::sample(const Vec3f& point, Vec3f& gradient) const {
  if (ball > 0) {
    const float distance = point.norm();
    gradient = distance > 0 ? Vec3f(point / distance) : Vec3f(Vec3f::UnitZ());
    return distance - ball;
  }
  const Cell c = locate(*this, point);
  const float x0 = mix(c.c[0], c.c[1], c.u), x1 = mix(c.c[2], c.c[3], c.u);
  const float x2 = mix(c.c[4], c.c[5], c.u), x3 = mix(c.c[6], c.c[7], c.u);
  const float y0 = mix(x0, x1, c.v), y1 = mix(x2, x3, c.v);
  const float dx0 = mix(c.c[1] - c.c[0], c.c[3] - c.c[2], c.v), dx1 = mix(c.c[5] - c.c[4], c.c[7] - c.c[6], c.v);
  gradient = Vec3f(mix(dx0, dx1, c.w), mix(x1 - x0, x3 - x2, c.w), y1 - y0);
  const float length = gradient.norm();
  // On the medial axis the slopes of both sides cancel: out is then away from the centre of mass.
  if (length > 1e-3f * cell)  // differences of neighbours: a slope of 1 is one cell
    gradient /= length;
  else
    gradient = point.squaredNorm() > 0 ? Vec3f(point.normalized()) : Vec3f(Vec3f::UnitZ());
  const float distance = mix(y0, y1, c.w);
  return c.outside > 0 ? std::max(distance, c.outside + padding) : distance;
}

namespace {

/// A sharp convex edge of the mesh.
struct SharpEdge {
  std::uint32_t a, b;
};

/// Edges over which the surface bends outwards by more than `angle`. Concave edges cannot touch first.
std::vector<SharpEdge> sharp_edges(const Mesh& mesh, double angle) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::size_t>> sides;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int e = 0; e < 3; ++e) {
      const std::uint32_t a = mesh.triangles[t][e], b = mesh.triangles[t][(e + 1) % 3];
      sides[std::minmax(a, b)].push_back(t);
    }
  std::vector<SharpEdge> sharp;
  for (const auto& [ends, faces] : sides) {
    if (faces.size() != 2) {
      sharp.push_back({ends.first, ends.second});
      continue;
    }
    const Vec3 n0 = mesh.area_vector(faces[0]).normalized(), n1 = mesh.area_vector(faces[1]).normalized();
    if (n0.dot(n1) > std::cos(angle)) continue;
    // Convex: the far corner of one face lies behind the other face.
    const auto& other = mesh.triangles[faces[1]];
    std::uint32_t far = other[0];
    for (const std::uint32_t v : other)
      if (v != ends.first && v != ends.second) far = v;
    if (n0.dot(mesh.vertices[far] - mesh.vertices[ends.first]) < 0) sharp.push_back({ends.first, ends.second});
  }
  return sharp;
}

/// Nodes and edge pieces before they are put in cluster order.
struct Draft {
  std::vector<Vec3> nodes;
  std::vector<Edge> edges;
};

/// Sharp edges cut in pieces no longer than `spacing`; corners appear once.
Draft edge_draft(const Mesh& mesh, const std::vector<SharpEdge>& sharp, double spacing) {
  Draft draft;
  std::map<std::uint32_t, std::uint32_t> corner;
  const auto node_of = [&](std::uint32_t vertex) {
    const auto [it, fresh] = corner.try_emplace(vertex, static_cast<std::uint32_t>(draft.nodes.size()));
    if (fresh) draft.nodes.push_back(mesh.vertices[vertex]);
    return it->second;
  };
  for (const SharpEdge& edge : sharp) {
    const Vec3 a = mesh.vertices[edge.a], b = mesh.vertices[edge.b];
    const int pieces = std::max(1, static_cast<int>(std::ceil((b - a).norm() / spacing)));
    std::uint32_t last = node_of(edge.a);
    for (int i = 1; i <= pieces; ++i) {
      std::uint32_t next;
      if (i == pieces) {
        next = node_of(edge.b);
      } else {
        next = static_cast<std::uint32_t>(draft.nodes.size());
        draft.nodes.push_back(a + (b - a) * (static_cast<double>(i) / pieces));
      }
      draft.edges.push_back({last, next});
      last = next;
    }
  }
  return draft;
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
  }
  for (Edge e : draft.edges) {
    Edge placed{place[e.a], place[e.b]};
    if (placed.a > placed.b) std::swap(placed.a, placed.b);
    samples.edges.push_back(placed);
  }
  std::sort(samples.edges.begin(), samples.edges.end(),
            [](const Edge& x, const Edge& y) { return std::make_pair(x.a, x.b) < std::make_pair(y.a, y.b); });
  const std::size_t clusters = (samples.nodes.size() + cluster_size - 1) / cluster_size;
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
  return samples;
}

double total_length(const Mesh& mesh, const std::vector<SharpEdge>& sharp) {
  double length = 0;
  for (const SharpEdge& e : sharp) length += (mesh.vertices[e.a] - mesh.vertices[e.b]).norm();
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
  samples.clusters = samples.groups = {{Vec3f::Zero(), 0}};
  samples.first_edge = {0, 0};
  samples.radius = samples.spacing = radius;
  return samples;
}

/// About `count` nodes: two thirds of them on sharp edges where there are such, the others on faces.
Samples make_samples(const PartModel& part, int count, double sharp_angle) {
  const Mesh& mesh = part.mesh();
  std::vector<SharpEdge> sharp = sharp_edges(mesh, sharp_angle);
  // A finely tessellated curve has many slightly bent edges: keep the sharpest until the nodes suffice.
  while (sharp.size() > static_cast<std::size_t>(2 * count) && sharp_angle < 1.5)
    sharp = sharp_edges(mesh, sharp_angle *= 1.3);
  const double spacing = std::max(total_length(mesh, sharp) / (0.67 * count), 0.004 * part.diagonal());
  Draft draft = edge_draft(mesh, sharp, spacing);
  const int faces = std::max(count / 4, count - static_cast<int>(draft.nodes.size()));
  // Face nodes, but for those that stand on a sharp edge already covered.
  const std::size_t on_edges = draft.nodes.size();
  for (const SurfaceSample& sample : part.samples({faces, sharp_angle}).samples) {
    const auto near = [&](const Vec3& node) { return (node - sample.point).norm() < 0.5 * spacing; };
    if (std::none_of(draft.nodes.begin(), draft.nodes.begin() + on_edges, near)) draft.nodes.push_back(sample.point);
  }
  return clustered(draft, part.mass().center, spacing);
}

}  // namespace

Shape make_shape(const PartModel& part, int coarse, int fine, double field_cell) {
  Shape shape;
  const MassProperties& mass = part.mass();
  shape.center = mass.center.cast<float>();
  shape.diagonal = static_cast<float>(part.diagonal());
  shape.radius = static_cast<float>(part.radius());
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
