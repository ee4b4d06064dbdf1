/// A mesh with its search tree in Embree and data of its triangles. It is made once for each model. Only this layer
/// uses Embree.
#pragma once

#include "bin_scenes/raster/scenery.hpp"

#include <embree3/rtcore.h>

#include <array>
#include <memory>
#include <mutex>
#include <vector>

namespace bin_scenes {

/// Returns the Embree device. Its instruction set is fixed, so that all processors that have it compute the same bits,
/// and likewise all processors without it. Embree's setting `threads` is not used, as it limits the threads of the
/// whole process.
RTCDevice embree_device();

/// Builds a search tree in one thread. The number of threads must not influence how a tree is built, because the order
/// of its triangles decides which of two triangles that are hit at the same point is reported.
void commit(RTCScene scene);

/// The normals of a triangle that approximates a curved surface: a linear interpolation of the normals at its corners.
/// The normal at a corner is the mean, by area, of the surrounding faces that are nearly in line with the triangle. All
/// values are in the frame of the mesh.
struct SmoothNormals {
  Vec3 at_origin = Vec3::Zero();  ///< normal at the origin of the mesh frame, extrapolated
  Mat3 slope = Mat3::Zero();      ///< 1/m, change of the normal with the position
  bool even = true;               ///< whether the normal is the face's everywhere
  Vec3 at(const Vec3& point) const { return at_origin + slope * point; }
};

/// A mesh and its search tree.
struct MeshTree {
  /// The model whose mesh this is, which keeps it alive; null: the mesh is `own`.
  PartModelPtr owner;
  Mesh own;
  RTCScene embree = nullptr;
  /// The plane of each triangle, in the frame of the mesh.
  std::vector<Scenery::Plane> planes;
  std::vector<char> outermost;  // for each triangle: whether the whole mesh is behind its plane
  bool closed = false;
  /// Vertex normals of each triangle, made on first use.
  const std::vector<SmoothNormals>& smooth_normals() const;

  const Mesh& mesh() const { return owner ? owner->mesh() : own; }

  MeshTree(PartModelPtr model, Mesh alone);
  ~MeshTree() { rtcReleaseScene(embree); }
  MeshTree(const MeshTree&) = delete;
  MeshTree& operator=(const MeshTree&) = delete;

 private:
  mutable std::once_flag once_;
  mutable std::vector<SmoothNormals> smooth_;
};
using MeshTreePtr = std::shared_ptr<const MeshTree>;

}  // namespace bin_scenes
