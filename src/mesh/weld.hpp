/// Welds a mesh: merges vertices that are equal within a tolerance, and removes the triangles that become degenerate.
/// It also removes slivers and duplicate triangles. These are the first steps of the repair in mesh_loader.cpp.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"

#include <cstddef>

namespace bin_scenes::repair {

/// Merges vertices closer than `tolerance` into the first of them, and removes unused vertices and the triangles that
/// collapse to an edge. The neighbours of such a triangle meet each other afterwards: no hole opens.
struct Welded {
  std::size_t vertices = 0, triangles = 0;  ///< numbers of those that were removed
};
Welded weld(Mesh& mesh, double tolerance);

/// Removes triangles whose height over the longest side is at most `tolerance`, and returns their number. Their
/// neighbours then meet at T-junctions, which split_t_junctions() resolves.
std::size_t remove_slivers(Mesh& mesh, double tolerance);

/// Keeps one of several equal triangles. A triangle and its mirror image bound nothing: both are removed, or one of
/// them is kept if `keep_one_side`.
struct Duplicates {
  std::size_t same = 0, opposite_pairs = 0;
};
Duplicates remove_duplicates(Mesh& mesh, bool keep_one_side);

}  // namespace bin_scenes::repair
