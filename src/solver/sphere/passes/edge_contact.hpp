/// Contacts at sharp edges: includes shaders/shared/sphere/edge.h and crease.h as C++ and provides the functions that
/// they require. slide.hpp uses them to find the contact of an edge.
#pragma once

#include "solver/sphere/shapes/contact_samples.hpp"
#include "solver/sphere/shapes/field.hpp"

namespace bin_scenes::sphere {

inline const Vec3f& node_at(const Samples& samples, uint i) {
  return i < samples.nodes.size() ? samples.nodes[i] : samples.crease_ends[i - samples.nodes.size()];
}
inline const Cone& cone_at(const Samples& samples, uint i) {
  return samples.cones[i];
}
inline uint first_crease(const Samples& samples) {
  return samples.first_edge.back();
}
inline const Edge& edge_at(const Samples& samples, uint e) {
  return samples.edges[e];
}
inline float length_of(const Edge& edge) {
  return edge.length;
}

struct Range {
  uint first, end;
};

inline Range edges_near(const Samples& samples, const Field& field, const Vec3f& point) {
  const auto [first, end] = samples.edge_grid.near(field, point);
  return {first, end};
}
inline uint listed_edge(const Samples& samples, uint k) {
  return samples.edge_grid.edges[k];
}

#include "shared/sphere/edge.h"

#include "shared/sphere/crease.h"

}  // namespace bin_scenes::sphere
