/// Invariants of a world between the passes of a step. Passes assert them where they begin or end; they are evaluated
/// only if assertions are on (core/assertion.hpp).
#pragma once

#include "bin_scenes/core/assertion.hpp"
#include "solver/sphere/world.hpp"

#include <utility>

namespace bin_scenes::sphere {

/// Whether the manifolds are in ascending order of (a, b) without duplicates, with a < b, and whether both bodies
/// exist.
inline bool manifolds_ascend(const World& world) {
  std::pair<std::uint32_t, std::uint32_t> last{0, 0};
  for (const Manifold& m : world.manifolds) {
    const std::pair key{m.a, m.b};
    const bool in_range = m.a < m.b && m.a < world.bodies.size() && (m.b == ground || m.b < world.bodies.size());
    if (!in_range || key <= last) return false;
    last = key;
  }
  return true;
}

inline bool contacts_have_room(const World& world) {
  return each_is(world.manifolds, [](const Manifold& m) { return m.contacts.size() <= max_contacts; });
}

/// Whether no two of the manifolds to solve share a moving body and a color. The last color is excepted, which holds
/// the manifolds that fit into no other color.
inline bool colors_share_no_body(const World& world) {
  std::vector<std::uint64_t> used(world.bodies.size(), 0);
  for (const std::uint32_t i : world.order) {
    const Manifold& m = world.manifolds.at(i);
    if (m.color < 0 || m.color >= SPHERE_COLORS) return false;
    const std::uint64_t bit = std::uint64_t{1} << m.color;
    for (const std::uint32_t body : {m.a, m.b}) {
      if (body == ground || !world.bodies[body].moves() || m.color == SPHERE_COLORS - 1) continue;
      if (used[body] & bit) return false;
      used[body] |= bit;
    }
  }
  return true;
}

/// Whether all contact normals have unit length, for bodies whose poses are finite.
inline bool normals_are_unit(const World& world) {
  return each_is(world.manifolds, [](const Manifold& m) {
    return each_is(m.contacts, [](const Contact& c) {
      const float square = c.local_normal.squaredNorm();
      return !std::isfinite(square) || std::abs(square - 1.0f) < 1e-3f;
    });
  });
}

/// Whether all orientations have unit length, for bodies whose poses are finite. A body that exploded has no pose,
/// which the heap reports.
inline bool orientations_are_unit(const World& world) {
  return each_is(world.bodies, [](const Body& b) {
    const float square = b.q.squaredNorm();
    return !b.present || !std::isfinite(square) || std::abs(square - 1.0f) < 1e-5f;
  });
}

}  // namespace bin_scenes::sphere
