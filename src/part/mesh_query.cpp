/// A tree of boxes over triangles, with the moments that a winding number needs far away (winding_terms.hpp). Nearest
/// points are exact.
#include "bin_scenes/part/mesh_query.hpp"

#include "bin_scenes/core/assertion.hpp"

#include "ray_parity.hpp"
#include "tree_walk.hpp"
#include "winding_terms.hpp"

#include <algorithm>
#include <array>
#include <numeric>

namespace bin_scenes {

namespace {

constexpr int sah_depth = 32;  // deeper nodes are halved by count, which bounds the depth
constexpr std::size_t stack_size = 2 + sah_depth + 32;
constexpr int bins = 12;

using Node = MeshQuery::Node;
using NodeBox = MeshQuery::NodeBox;

double squared_distance(const Aabb& box, const Vec3& p) {
  const Vec3 out = (box.lower - p).cwiseMax(p - box.upper).cwiseMax(0.0);
  return out.squaredNorm();
}

/// Nearest point of a triangle by the Voronoi regions of its features (Ericson 2005, "Real-Time Collision
/// Detection", section 5.1.5).
Vec3 nearest_on_triangle(const Corner& t, const Vec3& p) {
  const Vec3 ap = p - t.a;
  const double d1 = t.ab.dot(ap), d2 = t.ac.dot(ap);
  if (d1 <= 0.0 && d2 <= 0.0) return t.a;
  const Vec3 bp = ap - t.ab;
  const double d3 = t.ab.dot(bp), d4 = t.ac.dot(bp);
  if (d3 >= 0.0 && d4 <= d3) return t.a + t.ab;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return d1 > d3 ? Vec3(t.a + d1 / (d1 - d3) * t.ab) : t.a;
  const Vec3 cp = ap - t.ac;
  const double d5 = t.ab.dot(cp), d6 = t.ac.dot(cp);
  if (d6 >= 0.0 && d5 <= d6) return t.a + t.ac;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return d2 > d6 ? Vec3(t.a + d2 / (d2 - d6) * t.ac) : t.a;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 >= d3 && d5 >= d6) {
    const double along = (d4 - d3) + (d5 - d6);
    return along > 0.0 ? Vec3(t.a + t.ab + (d4 - d3) / along * (t.ac - t.ab)) : Vec3(t.a + t.ab);
  }
  const double sum = va + vb + vc;
  return t.a + vb / sum * t.ab + vc / sum * t.ac;
}

}  // namespace

/// Binary tree in depth-first order, split by the surface area heuristic over binned centroids.
struct MeshQuery::Tree {
  Mesh mesh;
  std::vector<Node> nodes;
  std::vector<NodeBox> boxes;    // one per node
  std::vector<Moments> moments;  // likewise
  std::vector<Corner> corners;   // in leaf order
  bool is_closed;

  explicit Tree(Mesh source) : mesh(std::move(source)), is_closed(closed(mesh)) {
    const std::size_t count = mesh.triangles.size();
    triangle_boxes_.resize(count);
    for (std::size_t t = 0; t < count; ++t) {
      for (const std::uint32_t v : mesh.triangles[t]) triangle_boxes_[t].extend(mesh.vertices[v]);
    }
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0u);
    if (count) {
      nodes.reserve(count);
      corners.reserve(count);
      build(order, 0, count, 0);
    }
    BIN_SCENES_ASSERT(corners.size() == count && moments.size() == nodes.size());
    BIN_SCENES_ASSERT(each_is(nodes, [&](const Node& node) {
      return node.count ? node.count <= leaf_size && node.first + node.count <= count : node.first < nodes.size();
    }));
    triangle_boxes_ = {};
    for (const Node& node : nodes) boxes.push_back(single(node.box));
  }

 private:
  std::vector<Aabb> triangle_boxes_;

  static NodeBox single(const Aabb& box) {
    NodeBox out{Eigen::Array4f::Zero(), Eigen::Array4f::Zero()};
    for (int k = 0; k < 3; ++k) {
      out.center[k] = static_cast<float>(0.5 * (box.lower[k] + box.upper[k]));
      const double half = std::max(box.upper[k] - out.center[k], out.center[k] - box.lower[k]);
      out.half[k] = std::nextafter(static_cast<float>(half), std::numeric_limits<float>::infinity());
    }
    return out;
  }

  /// Makes the node over order[begin, end) and everything below it.
  void build(std::vector<std::uint32_t>& order, std::size_t begin, std::size_t end, int depth) {
    const std::size_t index = nodes.size();
    nodes.emplace_back();
    moments.emplace_back();
    Aabb box, centers;
    for (std::size_t i = begin; i < end; ++i) {
      box.extend(triangle_boxes_[order[i]]);
      centers.extend(triangle_boxes_[order[i]].center());
    }
    nodes[index].box = box;
    const std::size_t first_corner = corners.size();
    if (end - begin <= MeshQuery::leaf_size) {
      nodes[index].first = static_cast<std::uint32_t>(first_corner);
      nodes[index].count = static_cast<std::uint32_t>(end - begin);
      std::sort(order.begin() + begin, order.begin() + end);
      for (std::size_t i = begin; i < end; ++i) {
        const auto& [a, b, c] = mesh.triangles[order[i]];
        const Vec3& va = mesh.vertices[a];
        corners.push_back({va, mesh.vertices[b] - va, mesh.vertices[c] - va, order[i]});
      }
    } else {
      const std::size_t mid = split(order, begin, end, centers, depth);
      build(order, begin, mid, depth + 1);
      nodes[index].first = static_cast<std::uint32_t>(nodes.size());
      build(order, mid, end, depth + 1);
    }
    moments[index] = moments_of(corners, first_corner, corners.size());
  }

  std::size_t split(std::vector<std::uint32_t>& order, std::size_t begin, std::size_t end, const Aabb& centers,
                    int depth) const {
    int axis;
    const double extent = centers.size().maxCoeff(&axis);
    const double low = centers.lower[axis];
    const auto center = [&](std::uint32_t t) {
      return 0.5 * (triangle_boxes_[t].lower[axis] + triangle_boxes_[t].upper[axis]);
    };
    if (extent > 0.0 && depth < sah_depth) {
      const auto bin_of = [&](std::uint32_t t) {
        return std::min(bins - 1, static_cast<int>(bins * ((center(t) - low) / extent)));
      };
      std::array<Aabb, bins> boxes;
      std::array<std::size_t, bins> counts{};
      for (std::size_t i = begin; i < end; ++i) {
        const int bin = bin_of(order[i]);
        boxes[bin].extend(triangle_boxes_[order[i]]);
        ++counts[bin];
      }
      std::array<double, bins> upper_cost{};
      Aabb box;
      std::size_t count = 0;
      for (int bin = bins - 1; bin > 0; --bin) {
        box.extend(boxes[bin]);
        upper_cost[bin] = half_area(box) * static_cast<double>(count += counts[bin]);
      }
      box = {};
      count = 0;
      int best = -1;
      double best_cost = std::numeric_limits<double>::infinity();
      for (int bin = 1; bin < bins; ++bin) {
        box.extend(boxes[bin - 1]);
        count += counts[bin - 1];
        const double cost = half_area(box) * static_cast<double>(count) + upper_cost[bin];
        if (count > 0 && count < end - begin && cost < best_cost) {
          best_cost = cost;
          best = bin;
        }
      }
      if (best > 0) {
        const auto mid = std::partition(order.begin() + begin, order.begin() + end,
                                        [&](std::uint32_t t) { return bin_of(t) < best; });
        return static_cast<std::size_t>(mid - order.begin());
      }
    }
    const std::size_t mid = begin + (end - begin) / 2;
    std::nth_element(order.begin() + begin, order.begin() + mid, order.begin() + end,
                     [&](std::uint32_t s, std::uint32_t t) {
                       const double cs = center(s), ct = center(t);
                       return cs != ct ? cs < ct : s < t;
                     });
    return mid;
  }

  static double half_area(const Aabb& box) {
    if (box.empty()) return 0.0;
    const Vec3 s = box.size();
    return s.x() * s.y() + s.y() * s.z() + s.z() * s.x();
  }
};

MeshQuery::MeshQuery(Mesh mesh) {
  BIN_SCENES_ASSERT(indices_in_range(mesh));
  BIN_SCENES_ASSERT(each_is(mesh.vertices, [](const Vec3& v) { return v.allFinite(); }));
  tree_ = std::make_unique<Tree>(std::move(mesh));
}
MeshQuery::~MeshQuery() = default;
MeshQuery::MeshQuery(MeshQuery&&) noexcept = default;
MeshQuery& MeshQuery::operator=(MeshQuery&&) noexcept = default;

const Mesh& MeshQuery::mesh() const {
  return tree_->mesh;
}

const std::vector<MeshQuery::Node>& MeshQuery::nodes() const {
  return tree_->nodes;
}

const std::vector<MeshQuery::NodeBox>& MeshQuery::boxes() const {
  return tree_->boxes;
}

std::size_t MeshQuery::leaf_triangle(std::size_t position) const {
  return tree_->corners[position].triangle;
}

NearestPoint MeshQuery::nearest(const Vec3& point, double limit) const {
  const std::vector<Node>& nodes = tree_->nodes;
  NearestPoint best;
  best.distance = std::numeric_limits<double>::infinity();
  double best2 = limit * limit;
  bool found = false;
  struct Entry {
    std::uint32_t node;
    double distance2;
  };
  std::array<Entry, stack_size> stack;
  std::size_t top = 0;
  if (!nodes.empty()) stack[top++] = {0, squared_distance(nodes[0].box, point)};
  while (top > 0) {
    const Entry entry = stack[--top];
    if (entry.distance2 > best2) continue;
    const Node& node = nodes[entry.node];
    if (node.count) {
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
        const Corner& corner = tree_->corners[i];
        const Vec3 candidate = nearest_on_triangle(corner, point);
        const double distance2 = (candidate - point).squaredNorm();
        if (distance2 < best2 || (!found && distance2 <= best2)) {
          best2 = distance2;
          best.point = candidate;
          best.triangle = corner.triangle;
          found = true;
        }
      }
      continue;
    }
    Entry near{entry.node + 1, squared_distance(nodes[entry.node + 1].box, point)};
    Entry far{node.first, squared_distance(nodes[node.first].box, point)};
    if (far.distance2 < near.distance2) std::swap(near, far);
    if (far.distance2 <= best2) stack[top++] = far;
    if (near.distance2 <= best2) stack[top++] = near;
  }
  if (found) best.distance = std::sqrt(best2);
  return best;
}

double MeshQuery::winding(const Vec3& point) const {
  double angle = 0.0;
  SolidAngles near;
  const auto sum_far = [&](std::uint32_t index) {
    const Moments& moments = tree_->moments[index];
    const double far = far_ratio * moments.reach;
    if (!((moments.center - point).squaredNorm() > far * far)) return false;
    angle += far_solid_angle(moments, point);
    return true;
  };
  any_leaf(tree_->nodes, sum_far, [&](std::uint32_t i) {
    near.add(tree_->corners[i], point);
    return false;
  });
  return (angle + near.sum()) / (4.0 * M_PI);
}

bool MeshQuery::inside(const Vec3& point) const {
  if (!tree_->is_closed) return winding(point) > 0.5;
  int sum = 0;
  const auto missed = [&](std::uint32_t index) { return !ray_meets(tree_->nodes[index].box, point); };
  const bool unclear = any_leaf(tree_->nodes, missed, [&](std::uint32_t i) {
    const Corner& t = tree_->corners[i];
    const std::optional<int> change = crossing(t.a, t.ab, t.ac, point);
    sum += change.value_or(0);
    return !change;
  });
  return unclear ? winding(point) > 0.5 : sum > 0;
}

double MeshQuery::signed_distance(const Vec3& point) const {
  const double distance = nearest(point).distance;
  return inside(point) ? -distance : distance;
}

void MeshQuery::overlapping_impl(const Aabb& box, void (*visit)(void*, std::size_t), void* context) const {
  const auto apart = [&](const Aabb& of_node) { return !of_node.overlaps(box); };
  any_near(*this, apart, [&](std::size_t triangle) {
    Aabb bounds;
    for (const std::uint32_t v : tree_->mesh.triangles[triangle]) bounds.extend(tree_->mesh.vertices[v]);
    if (bounds.overlaps(box)) visit(context, triangle);
    return false;
  });
}

}  // namespace bin_scenes
