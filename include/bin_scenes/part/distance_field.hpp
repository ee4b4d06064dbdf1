/// Signed distance to a mesh on a regular grid: negative inside; also for concave, hollow and overlapping shells.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"

#include <array>
#include <vector>

namespace bin_scenes {

struct DistanceField {
  Vec3 origin = Vec3::Zero();  ///< model frame position of node (0,0,0)
  double cell = 0.0;           ///< m
  std::array<int, 3> nodes = {0, 0, 0};
  std::vector<float> values;  ///< nodes[0]*nodes[1]*nodes[2], x fastest; m
  bool coarsened = false;     ///< the cell is larger than requested, because of max_nodes

  float at(int x, int y, int z) const {
    return values[static_cast<std::size_t>(x) +
                  nodes[0] * (static_cast<std::size_t>(y) + static_cast<std::size_t>(nodes[1]) * z)];
  }
  /// Trilinear; outside the grid: value at the nearest point of the grid plus the distance to it; this is not
  /// always a lower bound.
  double distance(const Vec3& point) const;
  /// Gradient of the trilinear interpolant, normalised; zero where it vanishes.
  Vec3 normal(const Vec3& point) const;
};

struct FieldOptions {
  double cell = 0.01;                ///< / bounding diagonal
  double padding = 3.0;              ///< cells around the bounding box
  std::size_t max_nodes = 8u << 20;  ///< above this number the cell is enlarged, and `coarsened` is set
};

class MeshQuery;

/// Exact at every node within three cells of the surface; contacts read no others. Farther away, the distance to the
/// nearest triangle found for a neighbouring node: never too small, too large by 0.01 cell on average and by less than
/// half a cell at most. Sign by the generalised winding number (Jacobson et al. 2013, "Robust inside-outside
/// segmentation using generalized winding numbers"), evaluated once per region that no surface divides.
DistanceField distance_field(const Mesh& mesh, const FieldOptions& options = {});
DistanceField distance_field(const MeshQuery& query, const FieldOptions& options = {});

}  // namespace bin_scenes
