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
  std::uint32_t a, b;                     ///< indices of its vertices, a < b
  std::array<std::size_t, 2> faces = {};  ///< the two faces of the edge, if there are two, as in a closed mesh
  bool closed = false;
  double cosine = -1.0;  ///< cosine of the angle between the normals; -1 if there are not two faces
  bool convex = true;
};

/// Returns all edges at which the surface bends by more than `angle` (rad), in order of (a, b).
std::vector<Fold> folds_of(const Mesh& mesh, double angle);

/// Returns the normal cone of an edge: the directions between the normals of its faces. Its bounds are unit vectors
/// across the edge into each face, and along the edge. There are no bounds if a face is a sliver.
Cone edge_cone(const Mesh& mesh, std::uint32_t a, std::uint32_t b, const std::array<std::size_t, 2>& faces);

/// A sharp convex edge between two vertices of the mesh.
struct SharpEdge {
  std::uint32_t a, b;  ///< indices of its vertices, a < b
  Cone cone;
};

struct SharpEdges {
  std::vector<SharpEdge> convex;  ///< in order of (a, b)
  std::vector<bool> saddles;      ///< by vertex: whether a concave edge ends there as well
};

/// Returns the convex folds by more than `angle` (rad). Concave edges cannot touch first.
SharpEdges sharp_edges(const Mesh& mesh, const std::vector<Fold>& folds, double angle);

/// Returns the number of convex folds by at least `angle` (rad).
double sharp_count(const std::vector<Fold>& folds, double angle);

/// Returns the total length (m) of the convex folds by at least `angle` (rad).
double sharp_length(const Mesh& mesh, const std::vector<Fold>& folds, double angle);

/// Replaces each run of edges by one edge from which it deviates by at most `most_off` (m): a smooth outline is often
/// divided into thousands of edges, each of which would get nodes of its own.
SharpEdges straightened(const Mesh& mesh, SharpEdges sharp, double most_off);

}  // namespace bin_scenes::sphere
