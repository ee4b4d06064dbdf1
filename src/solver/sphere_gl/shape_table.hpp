/// The collision shapes of all parts in the buffers that find_contacts reads: nodes, edges, clusters and distance
/// fields, one after the other. A shape is uploaded once, however many worlds use it.
#pragma once

#include "bin_scenes/gl/buffer.hpp"
#include "shared/sphere.h"
#include "solver/sphere/shapes/shape.hpp"

#include <map>

namespace bin_scenes::sphere_gl {

class ShapeTable {
 public:
  /// Returns the index of a shape on the device, and uploads it if it is new. Throws an input Error if the part has
  /// more samples than find_contacts can process (SPHERE_MAX_CLUSTERS).
  std::uint32_t index_of(const sphere::Shape& shape);
  void bind() const;
  std::size_t bytes() const;

 private:
  gpu::SphereSamples add(const sphere::Samples& samples);

  std::map<const sphere::Shape*, std::uint32_t> known_;
  std::size_t node_count_ = 0, edge_count_ = 0, cluster_count_ = 0, field_pair_count_ = 0;
  gl::Buffer<gpu::SphereShape> shapes_{"sphere.shapes"};
  gl::Buffer<gpu::SphereNode> nodes_{"sphere.nodes"};
  gl::Buffer<gpu::uvec4> edges_{"sphere.edges"};
  gl::Buffer<gpu::SphereCluster> clusters_{"sphere.clusters"};
  gl::Buffer<gpu::vec2> fields_{"sphere.fields"};
};

}  // namespace bin_scenes::sphere_gl
