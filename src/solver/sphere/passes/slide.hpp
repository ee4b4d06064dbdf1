/// Nodes of curved faces slide along the face to the point nearest to the other part.
#pragma once

#include "solver/sphere/shapes/contact_samples.hpp"
#include "solver/sphere/shapes/field.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace bin_scenes::sphere {

/// A node of a curved face stands for its surroundings: slides it along its own surface to where it lies deepest. The
/// way follows from the angle between the node's normal and the gradient of `depth(point, gradient)`, and from how fast
/// the normals turn (cone); the part's own field brings the point back to the surface. `point`, `gradient` and
/// `distance` are the node's own in the other frame, and are replaced.
template <class Depth>
void slide(const Samples& samples, const Field& own, const Carry& carry, std::size_t node, const Depth& depth,
           Vec3f& point, Vec3f& gradient, float& distance) {
  constexpr float flat = 0.02f;  // rad: below it the node itself is deep enough
  const Cone& cone = samples.cones[node];
  if (cone.axis.isZero() || cone.spread < flat || own.ball > 0 || samples.face_spacing <= 0) return;
  float way_per_angle = 2.0f * samples.face_spacing / cone.spread;
  Vec3f x = samples.nodes[node], normal = cone.axis;
  for (int i = 0; i < 6; ++i) {
    const Vec3f down = -(carry.rotation.transpose() * gradient);
    const Vec3f across = down - down.dot(normal) * normal;
    const float angle = across.norm();
    if (angle < flat || down.dot(normal) < 0.5f) return;
    Vec3f there = x + std::min(angle * way_per_angle, samples.face_spacing) / angle * across, normal_there, slope;
    const float off = own.sample(there, normal_there);
    there -= off * normal_there;
    const Vec3f carried = carry(there);
    const float deeper = depth(carried, slope);
    // Past the deepest point, over the rim of the face, or where another node stands.
    if (deeper >= distance || std::abs(own.sample(there)) > 0.1f * own.cell ||
        (there - samples.nodes[node]).norm() > samples.face_spacing) {
      way_per_angle *= 0.5f;
      continue;
    }
    x = there;
    normal = normal_there;
    point = carried;
    gradient = slope;
    distance = deeper;
  }
}

}  // namespace bin_scenes::sphere
