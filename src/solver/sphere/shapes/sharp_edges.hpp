/// The sharp convex edges of a mesh, with the normal cone of each: the directions in which contacts may press on it.
/// Samples are placed on them, because parts touch there first.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"
#include "solver/sphere/passes/cone.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace bin_scenes::sphere {

/// An edge of the mesh and how its faces meet there.
struct Fold {
  std::uint32_t a, b;                     ///< a < b
  std::array<std::size_t, 2> faces = {};  ///< the two faces of the edge, if there are two, as in a closed mesh
  bool closed = false;
  double cosine = -1.0;  ///< cosine of the angle between the normals; -1 if there are not two faces
  bool convex = true;
};

/// All edges over which the surface bends by more than `angle` (rad), in order of (a, b).
std::vector<Fold> folds_of(const Mesh& mesh, double angle);

/// Directions between the normals of both faces of an edge, as bounds: across the edge into each face, and along it.
/// None beside a sliver.
Cone edge_cone(const Mesh& mesh, std::uint32_t a, std::uint32_t b, const std::array<std::size_t, 2>& faces);

/// A sharp convex edge between two vertices of the mesh.
struct SharpEdge {
  std::uint32_t a, b;  ///< a < b
  Cone cone;
};

struct SharpEdges {
  std::vector<SharpEdge> convex;  ///< in order of (a, b)
  std::vector<bool> saddles;      ///< by vertex: whether a concave edge ends there as well
};

/// The folds by more than `angle` (rad). Concave edges cannot touch first.
SharpEdges sharp_edges(const Mesh& mesh, const std::vector<Fold>& folds, double angle);

/// Number of the convex ones that are sharp.
double sharp_count(const std::vector<Fold>& folds, double angle);

/// Length of all that are convex, m.
double sharp_length(const Mesh& mesh, const std::vector<Fold>& folds, double angle);

/// One edge in place of each run of them that it leaves by at most `most_off` (m): a smooth outline is often cut into
/// thousands of edges, of which each would get nodes of its own.
SharpEdges straightened(const Mesh& mesh, SharpEdges sharp, double most_off);

}  // namespace bin_scenes::sphere
