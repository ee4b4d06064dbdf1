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

/// By the distance of one end, before that of the other is asked for, which often lies in another cluster.
bool edge_is_apart(const View& view, const Edge& edge, float distance) {
  return distance - edge.length >= view.margin + error_of(view.field);
}

/// Returns how many nodes it has.
std::size_t test_cluster(const View& view, std::size_t index) {
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
  for (uint e = samples.first_edge[index]; e < samples.first_edge[index + 1]; ++e) {
    const Edge& edge = samples.edges[e];
    const float distance_a = cluster.distance(edge.a);
    if (edge_is_apart(view, edge, distance_a)) continue;
    const float distance_b = cluster.distance(edge.b);
    if (!edge_may_touch(view, edge, distance_a, distance_b)) continue;
    Touch touch;
    if (touches_with_edge(view, e, cluster.touch(edge.a), cluster.touch(edge.b), touch))
      offer(view, touch, edge.cone, e | SPHERE_EDGE);
  }
  return count;
}

}  // namespace

void test_samples(const View& view, Counters& counters) {
  const Samples& samples = view.samples;
  const float slack = view.margin + samples.radius + samples.sag + error_of(view.field);
  Points<clusters_at_once> center;
  std::array<float, clusters_at_once> distance;
  counters.nodes_possible += samples.nodes.size();
  counters.clusters_tested += samples.clusters.size();
  for (std::size_t first = 0; first < samples.clusters.size(); first += clusters_at_once) {
    const std::size_t count = std::min(samples.clusters.size() - first, std::size_t{clusters_at_once});
    sample(view.field, view.to_field, samples.cluster_points[first / clusters_at_once], center, distance.data());
    for (std::size_t k = 0; k < count; ++k)
      if (distance[k] <= samples.clusters[first + k].radius + slack)
        counters.nodes_tested += test_cluster(view, first + k);
  }
}

}  // namespace bin_scenes::sphere
