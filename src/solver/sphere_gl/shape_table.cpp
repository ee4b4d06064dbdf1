#include "solver/sphere_gl/shape_table.hpp"

#include "bin_scenes/core/error.hpp"
#include "solver/sphere_gl/convert.hpp"

#include <algorithm>

namespace bin_scenes::sphere_gl {

namespace {

/// Appends behind the first `count` elements, which it moves on.
template <class T>
std::uint32_t append(gl::Buffer<T>& buffer, std::size_t& count, const T* values, std::size_t n) {
  const std::size_t first = count;
  count += n;
  if (count > buffer.size() || buffer.size() == 0) buffer.grow(std::max<std::size_t>(count, 1));
  if (n > 0) buffer.upload(first, values, n);
  return static_cast<std::uint32_t>(first);
}

/// Puts the vectors of a normal cone behind the nodes; returns how the pass finds them.
gpu::uint add_cone(const sphere::Cone& cone, std::vector<gpu::SphereNode>& nodes) {
  static_assert(sphere::Cone::max_bounds < SPHERE_AXIS, "three bits state how many");
  const auto at = static_cast<gpu::uint>(nodes.size()) << 3;
  if (cone.bounds > 0) {
    for (int i = 0; i < cone.bounds; ++i) nodes.push_back({three(cone.bound[i]), 0});
    return at | static_cast<gpu::uint>(cone.bounds);
  }
  if (cone.axis.isZero()) return 0;
  nodes.push_back({three(cone.axis), word_of(cone.spread)});
  return at | SPHERE_AXIS;
}

/// Four words each.
std::vector<gpu::uvec4> packed(const std::vector<std::uint32_t>& words) {
  std::vector<gpu::uvec4> out((words.size() + 3) / 4);
  for (std::size_t i = 0; i < words.size(); ++i) (&out[i / 4].x)[i % 4] = words[i];
  return out;
}

/// For each node of the grid but those of the last layer: its value and that of its neighbour along z. The eight values
/// around a point are then two pieces of 16 bytes.
std::vector<gpu::vec2> field_pairs(const sphere::Field& field) {
  std::vector<gpu::vec2> pairs;
  if (!field.values) return pairs;
  const std::size_t layer = std::size_t(field.nx) * field.ny, count = layer * (field.nz - 1);
  pairs.reserve(count);
  for (std::size_t i = 0; i < count; ++i) pairs.push_back({field.values[i], field.values[i + layer]});
  return pairs;
}

gpu::vec4 diagonal(const sphere::Mat3f& m) {
  return {m(0, 0), m(1, 1), m(2, 2), 0};
}
gpu::vec4 mixed(const sphere::Mat3f& m) {
  return {m(0, 1), m(0, 2), m(1, 2), 0};
}

}  // namespace

gpu::SphereSamples ShapeTable::add(const sphere::Samples& samples) {
  if (samples.clusters.size() > SPHERE_MAX_CLUSTERS)
    throw input_error("a part has " + std::to_string(samples.nodes.size()) + " contact samples, the GPU takes " +
                          std::to_string(SPHERE_MAX_CLUSTERS * SPHERE_CLUSTER),
                      "solver.sphere", "lower solver.sphere.fine_samples, or set solver.sphere.device: cpu");
  std::vector<gpu::SphereNode> nodes;
  for (const sphere::Vec3f& node : samples.nodes) nodes.push_back({three(node), 0});
  for (const sphere::Vec3f& end : samples.crease_ends) nodes.push_back({three(end), 0});
  for (std::size_t i = 0; i < samples.cones.size(); ++i) nodes[i].cone = add_cone(samples.cones[i], nodes);
  std::vector<gpu::uvec4> edges;
  for (const sphere::Edge& edge : samples.edges)
    edges.push_back({edge.a, edge.b, add_cone(edge.cone, nodes), word_of(edge.sharp ? edge.length : -edge.length)});
  std::vector<gpu::SphereCluster> clusters;
  for (std::size_t c = 0; c < samples.clusters.size(); ++c)
    clusters.push_back({vec4(samples.clusters[c].center, samples.clusters[c].radius),
                        {samples.first_edge[c], samples.first_edge[c + 1], 0, 0}});
  gpu::SphereSamples out{};
  out.nodes = {append(nodes_, node_count_, nodes.data(), nodes.size()), static_cast<gpu::uint>(samples.nodes.size()),
               append(edges_, edge_count_, edges.data(), edges.size()), static_cast<gpu::uint>(edges.size())};
  out.clusters = {append(clusters_, cluster_count_, clusters.data(), clusters.size()),
                  static_cast<gpu::uint>(clusters.size()), samples.first_edge.back(), 0};
  const sphere::EdgeGrid& grid = samples.edge_grid;
  const std::vector<gpu::uvec4> table = packed(grid.first), lists = packed(grid.edges);
  out.blocks = {append(edges_, edge_count_, table.data(), table.size()),
                append(edges_, edge_count_, lists.data(), lists.size()), static_cast<gpu::uint>(grid.row),
                static_cast<gpu::uint>(grid.slice)};
  out.size = {samples.radius, samples.spacing, samples.face_spacing, samples.sag};
  return out;
}

std::uint32_t ShapeTable::index_of(const sphere::Shape& shape) {
  const auto found = known_.find(&shape);
  if (found != known_.end()) return found->second;
  const sphere::Field& field = shape.field;
  gpu::SphereShape out{};
  out.coarse = add(shape.coarse);
  out.fine = add(shape.fine);
  out.box_center = vec4(shape.box_center, shape.radius);
  out.box_half = vec4(shape.box_half, shape.size);
  // In double precision: the determinant of a half-millimetre part's inertia is below what single precision can
  // distinguish from 0.
  const sphere::Mat3f inverse = shape.unit_inertia.cast<double>().inverse().cast<float>();
  out.inertia = diagonal(shape.unit_inertia);
  out.inertia_mixed = mixed(shape.unit_inertia);
  out.inverse_inertia = diagonal(inverse);
  out.inverse_inertia_mixed = mixed(inverse);
  out.origin = vec4(field.origin, field.cell);
  out.field = {field.inverse_cell, field.padding, field.ball, 0};
  const std::vector<gpu::vec2> values = field_pairs(field);
  out.grid = {static_cast<gpu::uint>(field.nx), static_cast<gpu::uint>(field.ny), static_cast<gpu::uint>(field.nz),
              append(fields_, field_pair_count_, values.data(), values.size())};
  std::size_t count = known_.size();
  return known_[&shape] = append(shapes_, count, &out, 1);
}

void ShapeTable::bind() const {
  shapes_.bind(BIND_SHAPES);
  nodes_.bind(BIND_NODES);
  edges_.bind(BIND_EDGES);
  clusters_.bind(BIND_CLUSTERS);
  fields_.bind(BIND_FIELDS);
}

std::size_t ShapeTable::bytes() const {
  return shapes_.storage().bytes() + nodes_.storage().bytes() + edges_.storage().bytes() + clusters_.storage().bytes() +
         fields_.storage().bytes();
}

}  // namespace bin_scenes::sphere_gl
