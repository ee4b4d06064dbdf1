/// The surface samples of a part, which are tested against the distance fields of other parts. All coordinates are in
/// the body frame: origin at the centre of mass, model axes.
///
///   nodes   points on the surface: corners, points along sharp convex edges, points of curved or flat faces
///   edges   straight pieces between two nodes of a sharp edge: where two parts cross edge on edge the deepest point
///           lies between nodes and is found by a local descent of the other part's field along the edge
///           (Macklin et al. 2020, "Local optimization for robust signed distance field collision")
///   creases   concave edges, where the surface folds inwards: nothing touches them first, but the distance field
///           bends there, and a body that enters
///           a crease is held by both of its faces
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

#include <array>
#include <cstdint>
#include <vector>

namespace bin_scenes::sphere {

struct Edge {
  std::uint32_t a, b;       ///< indices of the nodes at its ends; beyond the nodes: crease_ends
  float length = 0;         ///< m
  std::uint32_t sharp = 0;  ///< 1: a sharp edge between two faces, into which the first two bounds of the cone point;
                            ///< 0: a line of a rounded edge, or unknown
  Cone cone;
};

struct Ball {
  Vec3f center = Vec3f::Zero();
  float radius = 0;
};

constexpr int cluster_size = SPHERE_CLUSTER, clusters_at_once = 8;

/// The samples of a part at one resolution.
struct Samples {
  std::vector<Vec3f> nodes;                              ///< in cluster order
  std::vector<Cone> cones;                               ///< normal cones of the nodes
  std::vector<Points<cluster_size>> node_points;         ///< the same nodes, in groups of one cluster
  std::vector<Edge> edges;                               ///< in order of their first node, then creases
  std::vector<Vec3f> crease_ends;                        ///< end points of creases, numbered after the nodes
  std::vector<Ball> clusters;                            ///< spheres around nodes 16 c to 16 c + 15 and their edges
  std::vector<std::uint32_t> first_edge;                 ///< by cluster: index of its first edge; then the end
  std::vector<Points<clusters_at_once>> cluster_points;  ///< centres of the clusters, in groups of eight
  std::vector<std::array<float, clusters_at_once>> cluster_radii;  ///< their radii; -infinity where there is no cluster
  std::vector<std::array<float, cluster_size>> longest_edges;  ///< by cluster and node: length (m) of the longest edge
                                                               ///< whose first node it is; -infinity if there is none
  std::vector<std::uint32_t> edges_from;  ///< by node: index of the first edge whose first node it is; then the end
  float extent = 0;                       ///< m: largest distance of a node from the centre of mass
  EdgeGrid edge_grid;                     ///< made by make_shape(), with the field
  float spacing = 0;                      ///< m: length of the longest piece of an edge
  float face_spacing = 0;                 ///< m: mean distance between neighbouring nodes on faces
  float sag = 0;                          ///< m: height by which a curved face may bulge between nodes
  float radius = 0;  ///< m: radius of the nodes, 0 for points; a ball is one node with its own radius
};

// If nodes on edges were farther apart, they could not represent the edges: these belong to a curved face.
constexpr double longest_edge_piece = 0.03, edge_share = 0.5;  // share of d; share of the nodes

/// Makes about `count` nodes: half of them on sharp edges if there are any, the others on faces. `folds`: result of
/// folds_of() for the part's mesh, with an angle of at most `sharp_angle` (rad). Long edges that are not sharp get
/// nodes if they protrude between the other nodes by more than `ridge` (share of d).
Samples make_samples(const PartModel& part, const std::vector<Fold>& folds, int count, double sharp_angle,
                     double ridge);

/// Returns the samples of a ball of that radius (m): one node, its centre.
Samples ball_samples(float radius);

/// Version of the samples in cache files. Increase it whenever make_samples() returns other samples for the same part,
/// so that older files are ignored.
constexpr int samples_format = 10;

/// Lists the members for byte streams (core/byte_stream.hpp).
template <class Stream>
void members(Stream& stream, Samples& samples);

}  // namespace bin_scenes::sphere
