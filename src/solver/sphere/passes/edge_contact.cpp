#include "solver/sphere/passes/edge_contact.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes::sphere {

namespace {

/// Where the lines p + s u and r + t v are nearest, w = p - r; false where they are parallel to within a degree: nodes
/// stand for such edges.
/// @param uu  square of u's length
bool nearest_points(const Vec3f& u, float uu, const Vec3f& v, const Vec3f& w, float& s, float& t) {
  constexpr float as_parallel = 3e-4f;  // square of the sine
  const float uv = u.dot(v), vv = v.squaredNorm(), uw = u.dot(w), vw = v.dot(w), det = uu * vv - uv * uv;
  if (det < as_parallel * uu * vv) return false;
  s = (uv * vw - vv * uw) / det;
  t = (uu * vw - uv * uw) / det;
  return true;
}

/// Whether an edge can be pressed along a normal, where `out` is the way out of its part, roughly.
bool presses_between(const Edge& edge, const Vec3f& normal, const Vec3f& out) {
  constexpr float least_along = 0.3f;  // of the normal along `out`, which may lean, but not to the other side
  constexpr float most_beyond = 0.1f;  // of the normal beyond the faces of the edge: 6 degrees
  if (normal.dot(out) < least_along) return false;
  return edge.cone.bounds == 0 ||
         std::max(normal.dot(edge.cone.bound[0]), normal.dot(edge.cone.bound[1])) <= most_beyond;
}

}  // namespace

bool descend(const Field& field, const Vec3f& p, const Vec3f& q, const Vec3f& gradient_p, const Vec3f& gradient_q,
             float lowest_end, Vec3f& point, Vec3f& gradient, float& distance) {
  // Regula falsi on the slope along the edge, which is monotonic where the other surface is convex.
  const Vec3f along = q - p;
  float s0 = gradient_p.dot(along), s1 = gradient_q.dot(along);
  if (s0 >= 0 || s1 <= 0) return false;
  float t0 = 0, t1 = 1;
  for (int i = 0; i < 6; ++i) {
    // Halving every other time keeps the bracket shrinking where the slope jumps (the other part's sharp edge).
    const float t = i % 2 ? 0.5f * (t0 + t1) : t0 + (t1 - t0) * s0 / (s0 - s1);
    point = p + t * along;
    distance = field.sample(point, gradient);
    const float slope = gradient.dot(along);
    if (slope < 0) {
      t0 = t;
      s0 = slope;
    } else {
      t1 = t;
      s1 = slope;
    }
    if ((t1 - t0) < 0.02f) break;
  }
  return distance < lowest_end;
}

bool cross_edges(const Samples& other, const Field& field, const Vec3f& p, const Vec3f& q, Vec3f& point,
                 Vec3f& gradient, float& distance) {
  const Vec3f u = q - p, from = point, out = gradient;
  const float uu = u.squaredNorm();
  float nearest = std::min(2.0f * field.cell + std::abs(distance), EdgeGrid::reach * field.cell);
  bool found = false;
  const auto [begin, end] = other.edge_grid.near(field, from);
  for (const std::uint32_t* e = begin; e != end; ++e) {
    const Edge& edge = other.edges[*e];
    const Vec3f r = other.nodes[edge.a], v = other.nodes[edge.b] - r;
    float s, t;
    if (!nearest_points(u, uu, v, p - r, s, t) || s < 0 || s > 1 || t < 0 || t > 1) continue;
    const Vec3f on_u = p + s * u, between = on_u - (r + t * v);
    const float way = between.norm();
    if (way >= nearest) continue;
    Vec3f normal = u.cross(v).normalized();
    if (normal.dot(out) < 0) normal = -normal;
    if (!presses_between(edge, normal, out)) continue;
    nearest = way;
    point = on_u;
    gradient = normal;
    distance = between.dot(normal);
    found = true;
  }
  return found;
}

bool passes_edge(const Samples& other, const Field& field, const Vec3f& point, const Vec3f& direction, const Vec3f& out,
                 Vec3f& normal) {
  float nearest = field.cell;
  bool found = false;
  const auto [begin, end] = other.edge_grid.near(field, point);
  for (const std::uint32_t* e = begin; e != end; ++e) {
    const Edge& edge = other.edges[*e];
    if (!edge.sharp) continue;
    const Vec3f r = other.nodes[edge.a], v = other.nodes[edge.b] - r, w = point - r;
    float s, t;
    if (!nearest_points(direction, 1, v, w, s, t) || std::abs(s) > field.cell || t < 0 || t > 1) continue;
    const float way = (w + s * direction - t * v).norm();
    if (way >= nearest) continue;
    Vec3f across = direction.cross(v).normalized();
    if (across.dot(out) < 0) across = -across;
    if (!presses_between(edge, across, out)) continue;
    nearest = way;
    normal = across;
    found = true;
  }
  return found;
}

WaysOut ways_out_at_edge(const Samples& other, const Field& field, const Vec3f& point) {
  constexpr float like = 0.95f;  // cosine of normals that count as of one face
  // What stands out past a face by rounding is level with it. More, and what has passed an edge would still stand on
  // the face behind it.
  const float flush = 0.002f * field.cell;
  WaysOut ways;
  float way_of[WaysOut::most];  // to the edge that each is of
  float nearest = field.cell;
  WayOut outside{Vec3f::Zero(), 0};
  const auto add = [&](const Vec3f& normal, float distance, float way) {
    int i = 0;
    while (i < ways.count && ways.way[i].out.dot(normal) < like) ++i;
    if (i == WaysOut::most || (i < ways.count && way_of[i] <= way)) return;
    ways.way[i] = {normal, distance};
    way_of[i] = way;
    ways.count = std::max(ways.count, i + 1);
  };
  const auto [begin, end] = other.edge_grid.near(field, point);
  for (const std::uint32_t* e = begin; e != end; ++e) {
    const Edge& edge = other.edges[*e];
    if (!edge.sharp) continue;
    const Vec3f r = other.nodes[edge.a], v = other.nodes[edge.b] - r, w = point - r;
    const float vv = v.squaredNorm(), t = w.dot(v) / vv;
    if (t * edge.length < -flush || (t - 1) * edge.length > flush)
      continue;  // another edge's, or a corner's that is not convex all round
    const Vec3f off = w - t * v;
    const float way = off.norm();
    if (way >= field.cell) continue;
    const Vec3f &into_1 = edge.cone.bound[0], &into_2 = edge.cone.bound[1];
    Vec3f n1 = v.cross(into_1).normalized(), n2 = v.cross(into_2).normalized();
    if (n1.dot(into_2) > 0) n1 = -n1;
    if (n2.dot(into_1) > 0) n2 = -n2;
    const float d1 = off.dot(n1), d2 = off.dot(n2);
    add(n1, d1, way);
    add(n2, d2, way);
    if (way >= nearest) continue;
    nearest = way;
    if (d1 >= d2 && off.dot(into_1) >= 0)  // above a face
      outside = {n1, d1};
    else if (d2 >= d1 && off.dot(into_2) >= 0)
      outside = {n2, d2};
    else
      outside = {way > 0 ? Vec3f(off / way) : Vec3f((n1 + n2).normalized()), way};
  }
  const auto begin_ways = ways.way.begin(), end_ways = begin_ways + ways.count;
  if (std::any_of(begin_ways, end_ways, [&](const WayOut& w) { return w.distance > flush; })) {
    ways.way[0] = outside;
    ways.count = 1;
    return ways;
  }
  for (int i = 1; i < ways.count; ++i)  // shortest first
    for (int k = i; k > 0 && ways.way[k].distance > ways.way[k - 1].distance; --k)
      std::swap(ways.way[k], ways.way[k - 1]);
  return ways;
}

}  // namespace bin_scenes::sphere
