#include "solver/sphere/passes/sample_test.hpp"

#include "solver/sphere/passes/slide.hpp"

#include <algorithm>
#include <array>

namespace bin_scenes::sphere {

namespace {

void emit(const View& view, const Vec3f& on_a, const Vec3f& normal, float separation, std::uint32_t feature) {
  view.found.push_back({on_a, on_a + separation * normal, normal, separation, feature});
}

#include "shared/sphere/touch.h"

/// The nodes of a cluster in the field's frame, and their neighbours along edges.
class Cluster {
 public:
  Cluster(const View& view, std::size_t index) : view_(view), first_(index * cluster_size) {
    sample(view.field, view.to_field, view.samples.node_points[index], point_, distance_.data());
    for (float& d : distance_) d -= view.samples.radius;
  }

  Vec3f point(std::size_t node) const {
    return holds(node) ? point_[place(node)] : view_.to_field(view_.samples.nodes[node]);
  }
  const std::array<float, cluster_size>& distances() const { return distance_; }
  float distance(std::size_t node) const {
    return holds(node) ? distance_[node - first_] : view_.field.sample(point(node));
  }
  /// Few are needed.
  Vec3f gradient(std::size_t node) {
    if (!holds(node)) {
      Vec3f gradient;
      view_.field.sample(point(node), gradient);
      return gradient;
    }
    const std::size_t i = node - first_;
    if (!(known_ >> i & 1u)) view_.field.sample(point_[place(node)], gradient_[i]);
    known_ |= 1u << i;
    return gradient_[i];
  }

  Touch touch(std::size_t node) { return {point(node), gradient(node), distance(node)}; }

 private:
  bool holds(std::size_t node) const { return node - first_ < cluster_size; }
  int place(std::size_t node) const { return static_cast<int>(node - first_); }

  const View& view_;
  std::size_t first_;
  Points<cluster_size> point_;
  std::array<float, cluster_size> distance_;
  std::array<Vec3f, cluster_size> gradient_;
  std::uint32_t known_ = 0;
};

/// An upper bound of how far (m) a sample may move in the field until the step ends.
float reach_of(const View& view) {
  constexpr float rounding = 1.001f;
  const float radius = view.to_field.offset.norm() + view.samples.extent;
  return rounding * (view.drift.norm() + view.twist.norm() * radius);
}

/// Whether an edge has a contact only if its deepest point lies between its ends: neither end is so near that the edge
/// may cross an edge of the other part there, and neither arrives within a cell of the other part in this step.
/// touches_with_edge() then returns false for an edge whose depth increases towards an end.
bool only_between_ends(const View& view, const Edge& edge, float distance_a, float distance_b, float reach) {
  if (may_cross(view, edge, distance_a) || may_cross(view, edge, distance_b)) return false;
  const float to_cell = min(distance_a, distance_b) - view.field.cell;
  return to_cell <= 0 || to_cell >= reach;
}

/// Bit i is set where value[i] - less[i] is below `limit`.
template <std::size_t N>
std::uint32_t below(const std::array<float, N>& value, const std::array<float, N>& less, float limit) {
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < N; ++i) bits |= static_cast<std::uint32_t>(value[i] - less[i] < limit) << i;
  return bits;
}

/// Calls visit(i) for each bit i that is set, in ascending order.
template <class Visit>
void for_each_bit(std::uint32_t bits, const Visit& visit) {
  for (; bits != 0; bits &= bits - 1) visit(static_cast<std::size_t>(__builtin_ctz(bits)));
}

void test_edge(const View& view, Cluster& cluster, uint e, float reach) {
  const Edge& edge = view.samples.edges[e];
  const float distance_a = cluster.distance(edge.a);
  // Decided by the distance of one end, before that of the other is asked for, which often lies in another cluster.
  if (distance_a - edge.length >= view.margin + error_of(view.field)) return;
  const float distance_b = cluster.distance(edge.b);
  if (!edge_may_touch(view, edge, distance_a, distance_b)) return;
  if (only_between_ends(view, edge, distance_a, distance_b, reach)) {
    const Vec3f along = cluster.point(edge.b) - cluster.point(edge.a);
    if (dot(cluster.gradient(edge.a), along) >= 0 || dot(cluster.gradient(edge.b), along) <= 0) return;
  }
  Touch touch;
  if (touches_with_edge(view, e, cluster.touch(edge.a), cluster.touch(edge.b), touch))
    offer(view, touch, edge.cone, e | SPHERE_EDGE);
}

/// Returns how many nodes it has.
std::size_t test_cluster(const View& view, std::size_t index, float reach) {
  const Samples& samples = view.samples;
  const std::size_t first = index * cluster_size;
  const std::size_t count = std::min(samples.nodes.size() - first, std::size_t{cluster_size});
  Cluster cluster(view, index);
  for (std::size_t node = first; node < first + count; ++node)
    if (node_may_touch(view, cluster.distance(node))) {
      const auto number = static_cast<uint>(node);
      Touch touch = cluster.touch(node);
      if (touches_with_node(view, number, touch)) offer(view, touch, cone_at(view.samples, number), number);
    }
  // No edge of the other nodes passes the first test of test_edge().
  const float apart = view.margin + error_of(view.field);
  for_each_bit(below(cluster.distances(), samples.longest_edges[index], apart), [&](std::size_t i) {
    for (uint e = samples.edges_from[first + i]; e < samples.edges_from[first + i + 1]; ++e)
      test_edge(view, cluster, e, reach);
  });
  return count;
}

}  // namespace

void test_samples(const View& view, Counters& counters) {
  const Samples& samples = view.samples;
  const float slack = view.margin + samples.radius + samples.sag + error_of(view.field);
  const float reach = reach_of(view);
  Points<clusters_at_once> center;
  std::array<float, clusters_at_once> distance;
  counters.nodes_possible += samples.nodes.size();
  counters.clusters_tested += samples.clusters.size();
  for (std::size_t group = 0; group < samples.cluster_points.size(); ++group) {
    sample(view.field, view.to_field, samples.cluster_points[group], center, distance.data());
    const std::array<float, clusters_at_once>& radius = samples.cluster_radii[group];
    std::uint32_t near = 0;
    for (std::size_t k = 0; k < clusters_at_once; ++k)
      near |= static_cast<std::uint32_t>(distance[k] <= radius[k] + slack) << k;
    for_each_bit(
        near, [&](std::size_t k) { counters.nodes_tested += test_cluster(view, group * clusters_at_once + k, reach); });
  }
}

}  // namespace bin_scenes::sphere
