/// Finds the holes of a surface, which are closed loops of open edges, and closes small ones with triangles. It is one
/// step of the repair in mesh_loader.cpp.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace bin_scenes::repair {

/// Returns the vertices of each boundary loop, in the direction in which a triangle that closes it passes them.
std::vector<std::vector<std::uint32_t>> boundary_loops(const Mesh& mesh);
double perimeter(const Mesh& mesh, const std::vector<std::uint32_t>& loop);

/// Closes boundary loops shorter than `max_perimeter`, and longer ones if the cover is inside the other shells of the
/// mesh, so that the outside does not change. Loops are closed by the triangulation with the smallest area (Barequet &
/// Sharir 1995, "Filling gaps in the boundary of a polyhedron"); very long loops are closed by a fan of triangles
/// around their centroid.
struct Closed {
  std::size_t small = 0, hidden = 0;  ///< number of loops that were short, and that were hidden
};
Closed close_holes(Mesh& mesh, double max_perimeter);

}  // namespace bin_scenes::repair
