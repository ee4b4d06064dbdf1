/// Finds the connected components (shells) of a surface, their volume and area, and the winding number of their
/// triangles about a point. The repair steps use them; they do not change the mesh.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"

#include <cstdint>
#include <vector>

namespace bin_scenes::repair {

/// The shell of each triangle: triangles that share an edge are in one shell. Shells are numbered by first triangle.
struct Shells {
  std::vector<std::uint32_t> of_triangle;
  std::size_t count = 0;
};
Shells shells(const Mesh& mesh);

double signed_volume(const Mesh& mesh);
double area(const Mesh& mesh);

/// Returns the winding number of some triangles of a mesh about a point, by the sum of their solid angles (van Oosterom
/// & Strackee 1983, "The solid angle of a plane triangle").
double winding(const Mesh& mesh, const std::vector<std::uint32_t>& triangles, const Vec3& p);

}  // namespace bin_scenes::repair
