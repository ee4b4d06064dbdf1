/// The repairs a loaded mesh goes through, one function each, in the order of src/scene/mesh_loader.cpp.
/// Lengths in the unit of the mesh. All of them are deterministic: ties go to the lower index.
#pragma once

#include "bin_scenes/scene/mesh.hpp"

#include <cstddef>
#include <vector>

namespace bin_scenes::repair {

/// Makes vertices closer than `tolerance` one (the one that comes first), drops unused vertices and the triangles
/// that collapse to an edge. Such a triangle's neighbours meet each other afterwards: no hole opens.
struct Welded {
  std::size_t vertices = 0, triangles = 0;
};
Welded weld(Mesh& mesh, double tolerance);

/// Removes triangles lower than `tolerance` over their longest side. Their neighbours then meet at T-junctions,
/// which split_t_junctions() resolves.
std::size_t remove_slivers(Mesh& mesh, double tolerance);

/// Keeps one of several equal triangles. A triangle and its mirror image bound nothing: both are removed, or one of
/// them is kept if `keep_one_side`.
struct Duplicates {
  std::size_t same = 0, opposite_pairs = 0;
};
Duplicates remove_duplicates(Mesh& mesh, bool keep_one_side);

/// Splits open edges at the vertices of other open edges that lie on them within `tolerance`: there a long edge on
/// one side meets two short ones on the other, without a gap. Returns the number of vertices inserted.
std::size_t split_t_junctions(Mesh& mesh, double tolerance);

/// Turns triangles so that neighbours agree on the side that is outside; in each shell the majority decides.
struct Agreement {
  std::size_t turned = 0;
  std::size_t conflicts = 0;  ///< edges that cannot be satisfied: the surface has only one side (Moebius)
};
Agreement agree_winding(Mesh& mesh);

/// Edges that more triangles pass in one direction than in the other, counted with that surplus. 0 = closed.
std::size_t open_edges(const Mesh& mesh);

/// Boundary loops, in the direction in which a triangle that closes them passes them.
std::vector<std::vector<std::uint32_t>> boundary_loops(const Mesh& mesh);
double perimeter(const Mesh& mesh, const std::vector<std::uint32_t>& loop);

/// Closes boundary loops shorter than `max_perimeter`, and longer ones where the cover lies inside the other shells of
/// the mesh, so that the outside is unchanged. By the triangulation of least area (Barequet & Sharir 1995, "Filling
/// gaps in the boundary of a polyhedron"); very long loops by a fan from their centroid.
struct Closed {
  std::size_t small = 0, hidden = 0;
};
Closed close_holes(Mesh& mesh, double max_perimeter);

/// Shell of each triangle, numbered by first triangle: connected over edges that two triangles share.
struct Shells {
  std::vector<std::uint32_t> of_triangle;
  std::size_t count = 0;
};
Shells shells(const Mesh& mesh);

double signed_volume(const Mesh& mesh);
double area(const Mesh& mesh);

/// Turns every outermost closed shell that encloses negative volume inside out, with all shells inside it: a cavity
/// stays a cavity. Returns the number of triangles turned.
std::size_t turn_outward(Mesh& mesh);

/// Pairs of solid shells of a closed mesh that overlap, found by points of one inside the other: at up to 200 triangle
/// centres and edge middles of each. Shallow overlaps may escape it. Cavities are not solid and do not count.
std::size_t overlapping_pairs(const Mesh& mesh);

/// An open surface as a closed shell of `thickness`: both sides offset by half of it along the vertex normals, the
/// rims joined. At folds the offset grows so that the faces keep their distance (at most twice the thickness).
void thicken(Mesh& mesh, double thickness);

}  // namespace bin_scenes::repair
