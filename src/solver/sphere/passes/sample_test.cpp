#include "solver/sphere/passes/sample_test.hpp"

#include "solver/sphere/passes/edge_contact.hpp"
#include "solver/sphere/passes/slide.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace bin_scenes::sphere {

namespace {

constexpr float nearly_all = 0.99f;  ///< of an exact way out a cone must leave: 8 degrees
constexpr float leans = 0.02f;       ///< sine of the angle by which a face leans against an edge that dips below it

/// How far (m) a sample at `point`, where the field is `distance`, is from being outside along a unit direction, having
/// been inside; nothing if it is not, for as long as `reach`.
std::optional<float> way_out(const Field& field, const Vec3f& point, const Vec3f& along, float distance, float reach) {
  const float least = 0.25f * field.cell;
  float t = 0, before = distance;
  bool inside = distance < 0;
  while (t < reach) {
    const float way = std::max(std::abs(before), least);
    t += way;
    const float now = field.sample(point + t * along);
    if (now >= 0 && inside) return t - way * now / (now - before);
    inside = inside || now < 0;
    before = now;
  }
  return {};
}

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

class SampleTest {
 public:
  SampleTest(const View& view, Candidates& out)
      : view_(view),
        samples_(view.samples),
        field_(view.field),
        out_(out),
        error_(field_.ball > 0 ? 0.0f : 0.5f * field_.cell) {}

  void run(Counters& counters) {
    const float slack = view_.margin + samples_.radius + samples_.sag + error_;
    Points<clusters_at_once> center;
    std::array<float, clusters_at_once> distance;
    counters.nodes_possible += samples_.nodes.size();
    counters.clusters_tested += samples_.clusters.size();
    for (std::size_t first = 0; first < samples_.clusters.size(); first += clusters_at_once) {
      const std::size_t count = std::min(samples_.clusters.size() - first, std::size_t{clusters_at_once});
      sample(field_, view_.to_field, samples_.cluster_points[first / clusters_at_once], center, distance.data());
      for (std::size_t k = 0; k < count; ++k)
        if (distance[k] <= samples_.clusters[first + k].radius + slack)
          counters.nodes_tested += test_cluster(first + k);
    }
  }

 private:
  std::size_t test_cluster(std::size_t index) {
    const std::size_t first = index * cluster_size;
    const std::size_t count = std::min(samples_.nodes.size() - first, std::size_t{cluster_size});
    Cluster cluster(view_, index);
    for (std::size_t node = first; node < first + count; ++node) test_node(cluster, node);
    for (std::uint32_t e = samples_.first_edge[index]; e < samples_.first_edge[index + 1]; ++e) test_edge(cluster, e);
    return count;
  }

  void test_node(Cluster& cluster, std::size_t node) {
    float distance = cluster.distance(node);
    if (distance >= view_.margin + samples_.sag) return;
    Vec3f point = cluster.point(node), out = cluster.gradient(node);
    const auto depth = [&](const Vec3f& p, Vec3f& gradient) { return field_.sample(p, gradient); };
    slide(samples_, view_.own, view_.to_field, node, depth, point, out, distance);
    if (distance < view_.margin) offer(point, out, distance, samples_.cones[node], static_cast<std::uint32_t>(node));
  }

  void test_edge(Cluster& cluster, std::uint32_t e) {
    const Edge& edge = samples_.edges[e];
    const float distance_p = cluster.distance(edge.a), distance_q = cluster.distance(edge.b);
    // It falls by no more than the way.
    if (0.5f * (distance_p + distance_q - edge.length) >= view_.margin) return;
    const Vec3f p = cluster.point(edge.a), q = cluster.point(edge.b);
    const Vec3f gradient_p = cluster.gradient(edge.a), gradient_q = cluster.gradient(edge.b);
    const std::uint32_t feature = e | edge_bit;
    Vec3f point, out;
    float distance;
    if (descend(field_, p, q, gradient_p, gradient_q, std::min(distance_p, distance_q), point, out, distance)) {
      const bool crossed = cross_edges(view_.other, field_, p, q, point, out, distance);
      if (distance >= view_.margin) return;
      if (!crossed || !press(point, out, distance, edge.cone, feature)) offer(point, out, distance, edge.cone, feature);
      return;
    }
    if (!edge.sharp || samples_.radius > 0) return;
    // Where edges are nearly parallel, or end, one dips below the other by less than the grid can tell.
    for (const bool from_p : {true, false}) {
      point = from_p ? p : q;
      out = from_p ? gradient_p : gradient_q;
      distance = from_p ? distance_p : distance_q;
      if (std::abs(distance) > field_.cell || !cross_edges(view_.other, field_, p, q, point, out, distance)) continue;
      if (distance < view_.margin) press(point, out, distance, edge.cone, feature, nearly_all);
      return;
    }
  }

  void offer(const Vec3f& point, Vec3f out, float distance, const Cone& cone, std::uint32_t feature) {
    if (offer_at_edge(point, cone, feature) || press(point, out, distance, cone, feature)) return;
    if (view_.way_back && distance < error_) offer_back(point, distance, cone, feature);
  }

  /// A sample that is inside, or as good as, and whose surface cannot be pressed against the nearest way out: of parts
  /// that lie flush (two plates side by side on the floor) that is the face level with it, although it is deeper in
  /// behind another. It goes back through its own body, along the middle of its cone, to the face it comes out of:
  /// for at most four cells, or, deep inside, unless it would be out sooner the other way, for then it did not come in
  /// through that face.
  void offer_back(const Vec3f& point, float distance, const Cone& cone, std::uint32_t feature) {
    const bool deep = distance < -2.0f * field_.cell;
    const Vec3f back = -(view_.to_field.rotation * cone.middle());
    const auto way = way_out(field_, point, back, distance, deep ? field_.span() : 4.0f * field_.cell);
    if (!way || (deep && way_out(field_, point, -back, distance, *way).value_or(*way) < *way)) return;
    Vec3f out;
    field_.sample(point + *way * back, out);
    const float behind = -*way * back.dot(out);
    if (behind <= 0) press(point, out, behind, cone, feature);
  }

  /// Near a sharp edge ways out are exact: what presses against none of them does not press there. Turned into the
  /// cone, the way out past an edge held up what leant on it from the side.
  bool offer_at_edge(const Vec3f& point, const Cone& cone, std::uint32_t feature) {
    if (samples_.radius > 0 || cone.all()) return false;  // which of two faces it presses against is not known
    const WaysOut ways = ways_out_at_edge(view_.other, field_, point);
    bool out_there = false;
    for (int i = 0; i < ways.count; ++i) {
      const auto& [out, distance] = ways.way[i];
      // Half a cell beyond is outside, unless this is a seam between shells that touch.
      if (field_.sample(point + (0.5f * field_.cell - distance) * out) < 0.3f * field_.cell) continue;
      out_there = true;
      Vec3f pressed = out;
      if (!turn(cone, pressed, nearly_all) || is_crossed(point, cone, out)) continue;
      emit(point, pressed, distance, feature);
      break;
    }
    return out_there;
  }

  /// A face that leans against an edge of the sample is not what it presses where that crosses an edge of the face: it
  /// presses along the normal of both edges, and two such nodes, one on each, would hold each other like a wedge.
  bool is_crossed(const Vec3f& point, const Cone& cone, const Vec3f& out) const {
    for (int i = 0; i < cone.bounds; ++i) {
      const Vec3f along = view_.to_field.rotation * cone.bound[i];
      Vec3f normal;
      if (along.dot(out) > -leans || !passes_edge(view_.other, field_, point, along, out, normal)) continue;
      if (turn(cone, normal, nearly_all)) return true;
    }
    return false;
  }

  /// A candidate, if the sample's own surface can be pressed against the way out: `least` of it must be left.
  bool press(const Vec3f& point, Vec3f out, float distance, const Cone& cone, std::uint32_t feature,
             float least = Cone::least_left) {
    if (!turn(cone, out, least)) return false;
    emit(point, out, distance, feature);
    return true;
  }

  /// Turns a way out so that the sample is pressed within its cone; false if less than `least` of it is left.
  bool turn(const Cone& cone, Vec3f& out, float least) const {
    Vec3f pressed = -(view_.to_field.rotation.transpose() * out);
    if (!cone.restrict(pressed, least)) return false;
    out = -(view_.to_field.rotation * pressed);
    return true;
  }

  void emit(const Vec3f& point, const Vec3f& out, float distance, std::uint32_t feature) {
    const Vec3f surface = point - samples_.radius * out, on_field = surface - distance * out;
    if (view_.to_a)
      out_.push_back(
          {(*view_.to_a)(surface), (*view_.to_a)(on_field), -(view_.to_a->rotation * out), distance, feature});
    else
      out_.push_back({on_field, surface, out, distance, feature | side_b});
  }

  const View& view_;
  const Samples& samples_;
  const Field& field_;
  Candidates& out_;
  const float error_;  ///< of the grid where it bends (m)
};

}  // namespace

void test_samples(const View& view, Counters& counters, Candidates& out) {
  SampleTest(view, out).run(counters);
}

}  // namespace bin_scenes::sphere
