/// Determines with one ray whether a point is inside a closed mesh: every surface that the ray passes changes the
/// winding number by one. It reports when rounding could change the answer, so that the caller can decide by another
/// method.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"

#include <optional>

namespace bin_scenes {

/// Returns whether every edge is used equally often in both directions. The test is a sum of hashes, which is zero
/// then, and otherwise is zero in one of 2^64 cases only.
bool closed(const Mesh& mesh);

/// The direction of all rays. It is along no edge or face that a designer would draw.
inline const Vec3 ray_direction{0.53812371, 0.31415927, 0.78214293};

/// Returns what the triangle (a, a + ab, a + ac) adds to the winding number of p by the ray of p: 1 if the ray leaves
/// the solid there, -1 if it enters, 0 if it misses the triangle. Returns none if rounding could change the result:
/// close to an edge, or if p is close to the triangle. It uses the signs of the volumes that ray and edges span (Segura
/// and Feito 2001, "Algorithms to test ray-triangle intersection. Comparative study").
std::optional<int> crossing(const Vec3& a, const Vec3& ab, const Vec3& ac, const Vec3& p);

/// Returns whether the ray of p meets the box.
bool ray_meets(const Aabb& box, const Vec3& p);

}  // namespace bin_scenes
