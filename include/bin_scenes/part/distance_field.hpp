/// Signed distance to a mesh on a regular grid (a signed distance field, SDF): negative inside, also for concave and
/// hollow meshes and for shells that overlap. The default solver looks up contact depths in it; between the nodes it is
/// an interpolation, so mesh_query.hpp is used where exact distances are needed.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"

#include <array>
#include <vector>

namespace bin_scenes {

/// A regular grid in the model frame with the signed distance at each node.
struct DistanceField {
  Vec3 origin = Vec3::Zero();  ///< position of node (0, 0, 0) in the model frame (m)
  double cell = 0.0;           ///< edge length of a cell (m)
  /// Numbers of nodes along x, y and z.
  std::array<int, 3> nodes = {0, 0, 0};
  std::vector<float> values;  ///< distances (m); nodes[0] * nodes[1] * nodes[2] values, x fastest
  bool coarsened = false;     ///< whether the cell is larger than requested, because of max_nodes

  float at(int x, int y, int z) const {
    return values[static_cast<std::size_t>(x) +
                  nodes[0] * (static_cast<std::size_t>(y) + static_cast<std::size_t>(nodes[1]) * z)];
  }
  /// Returns the trilinear interpolation (m). Outside the grid, it is the value at the nearest point of the grid plus
  /// the distance to that point, which is not always a lower bound.
  double distance(const Vec3& point) const;
  /// Returns the normalised gradient of the trilinear interpolation; zero where the gradient vanishes.
  Vec3 normal(const Vec3& point) const;
};

/// Resolution of the grid.
struct FieldOptions {
  double cell = 0.01;                ///< edge length of a cell / diagonal of the bounding box
  double padding = 3.0;              ///< width of the margin around the bounding box, in cells
  std::size_t max_nodes = 8u << 20;  ///< if the grid had more nodes, the cell is enlarged and `coarsened` is set
};

class MeshQuery;

/// Computes the distance field of a mesh. It is exact at every node within three cells of the surface, and contacts
/// read no other nodes. Farther away, a node stores the distance to the nearest of the triangles that were found for
/// neighbouring nodes: never too small, too large by 0.01 cell on average, and by less than half a cell at most. The
/// sign is that of the generalised winding number (Jacobson et al. 2013, "Robust inside-outside segmentation using
/// generalized winding numbers"), which is evaluated once for each region that no surface divides.
DistanceField distance_field(const Mesh& mesh, const FieldOptions& options = {});
DistanceField distance_field(const MeshQuery& query, const FieldOptions& options = {});

}  // namespace bin_scenes
