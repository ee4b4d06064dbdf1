/// The surface samples of a part that are tested against other parts' distance fields. In the body frame: origin at the
/// centre of mass, model axes.
///
///   nodes   points on the surface: corners, points along sharp convex edges, points of curved or flat faces
///   edges   straight pieces between two nodes of a sharp edge: where two parts cross edge on edge the deepest point
///           lies between nodes and is found by a local descent of the other part's field along the edge
///           (Macklin et al. 2020, "Local optimization for robust signed distance field collision")
///   creases   edges where the surface folds inwards: nothing of them touches first, but the field bends there, and
///   what
///           comes into one is held by both its faces
///   clusters   bounding spheres over 16 nodes: one field sample rejects all of them
///
/// Two faces touch at corners and edges of one of them, two curved surfaces at a point that some face node is near:
/// no contact needs more than these.
#pragma once

#include "bin_scenes/part/part_model.hpp"
#include "solver/sphere/passes/cone.hpp"
#include "solver/sphere/shapes/edge_grid.hpp"
#include "solver/sphere/shapes/field.hpp"
#include "solver/sphere/shapes/sharp_edges.hpp"

#include <cstdint>
#include <vector>

namespace bin_scenes::sphere {

struct Edge {
  std::uint32_t a, b;       ///< nodes
  float length = 0;         ///< m
  std::uint32_t sharp = 0;  ///< 1: two faces meet there, into which the first two bounds of the cone point; 0: a line
                            ///< of a rounded edge, or unknown
  Cone cone;
};

struct Ball {
  Vec3f center = Vec3f::Zero();
  float radius = 0;
};

constexpr int cluster_size = SPHERE_CLUSTER, clusters_at_once = 8;

/// Nodes at one resolution.
struct Samples {
  std::vector<Vec3f> nodes;                              ///< in cluster order
  std::vector<Cone> cones;                               ///< normal cones of the nodes
  std::vector<Points<cluster_size>> node_points;         ///< the same nodes, in groups of one cluster
  std::vector<Edge> edges;                               ///< in order of their first node's cluster, then creases
  std::vector<Vec3f> crease_ends;                        ///< counted on from the nodes
  std::vector<Ball> clusters;                            ///< nodes [16 c, 16 c + 16) and the edges that start there
  std::vector<std::uint32_t> first_edge;                 ///< clusters + 1
  std::vector<Points<clusters_at_once>> cluster_points;  ///< their centres, eight at a time
  EdgeGrid edge_grid;                                    ///< make_shape() makes it, with the field
  float spacing = 0;                                     ///< longest edge piece (m)
  float face_spacing = 0;                                ///< mean distance between neighbours on faces (m)
  float sag = 0;                                         ///< m by which a curved face may bulge between its nodes
  float radius = 0;  ///< radius of the nodes: 0 for points; a ball is one node with its own radius
};

// Where nodes on edges would stand farther apart they could not stand for them: the edges belong to a curved face.
constexpr double longest_edge_piece = 0.03, edge_share = 0.5;  // of d, of the nodes

/// About `count` nodes: half of them on sharp edges where there are such, the others on faces. `folds` are those of
/// the part's mesh by `sharp_angle` (rad) or less. Long edges that are not sharp get nodes where they stick out between
/// the others by more than `ridge` (of d).
Samples make_samples(const PartModel& part, const std::vector<Fold>& folds, int count, double sharp_angle,
                     double ridge);

/// A ball (of that radius, m) needs one node, its centre.
Samples ball_samples(float radius);

/// Version of the samples in cache files. Increase it whenever make_samples() returns other samples for the same part,
/// so that older files are ignored.
constexpr int samples_format = 10;

/// Lists the members for byte streams (core/byte_stream.hpp).
template <class Stream>
void members(Stream& stream, Samples& samples);

}  // namespace bin_scenes::sphere
