#include "solver/sphere/shapes/sample_clusters.hpp"

#include "bin_scenes/core/assertion.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <tuple>

namespace bin_scenes::sphere {

namespace {

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

}  // namespace

void lay_out(Samples& samples) {
  samples.node_points.resize(samples.clusters.size());
  for (std::size_t i = 0; i < samples.node_points.size() * cluster_size; ++i)
    samples.node_points[i / cluster_size].set(i % cluster_size, samples.nodes[std::min(i, samples.nodes.size() - 1)]);
  samples.cluster_points.resize((samples.clusters.size() + clusters_at_once - 1) / clusters_at_once);
  for (std::size_t i = 0; i < samples.cluster_points.size() * clusters_at_once; ++i)
    samples.cluster_points[i / clusters_at_once].set(i % clusters_at_once,
                                                     samples.clusters[std::min(i, samples.clusters.size() - 1)].center);
  constexpr float none = -std::numeric_limits<float>::infinity();
  samples.cluster_radii.resize(samples.cluster_points.size());
  for (auto& radii : samples.cluster_radii) radii.fill(none);
  for (std::size_t i = 0; i < samples.clusters.size(); ++i)
    samples.cluster_radii[i / clusters_at_once][i % clusters_at_once] = samples.clusters[i].radius;
  samples.longest_edges.resize(samples.node_points.size());
  for (auto& lengths : samples.longest_edges) lengths.fill(none);
  samples.edges_from.assign(samples.nodes.size() + 1, 0);
  for (std::uint32_t e = 0; e < samples.first_edge.back(); ++e) {
    const Edge& edge = samples.edges[e];
    ++samples.edges_from[edge.a + 1];
    float& longest = samples.longest_edges[edge.a / cluster_size][edge.a % cluster_size];
    longest = std::max(longest, edge.length);
  }
  std::partial_sum(samples.edges_from.begin(), samples.edges_from.end(), samples.edges_from.begin());
  samples.extent = 0;
  for (const Vec3f& node : samples.nodes) samples.extent = std::max(samples.extent, node.norm());
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
  BIN_SCENES_ASSERT(e == samples.edges.size() && samples.clusters.size() == clusters);
  BIN_SCENES_ASSERT(
      each_is(samples.edges, [&](const Edge& edge) { return edge.a <= edge.b && edge.b < samples.nodes.size(); }));
  lay_out(samples);
  return samples;
}

}  // namespace bin_scenes::sphere
