/// Rounded edges in shading. Edges of CAD models are razor sharp, those of real parts are broken by a bevel or fillet
/// that shines along the whole edge. Near a convex edge, the normal is that of a fillet between the two faces, where
/// the bisector of the faces through the point meets it. Outlines and depth stay those of the mesh.
#pragma once

#include "bin_scenes/raster/scenery.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace bin_scenes {

class Bevels {
 public:
  /// @param radius  m, of all fillets
  Bevels(const Scenery& scenery, double radius);
  /// Returns the unit normal (bin frame) at a point on a part that was hit. @param smooth  its normal without bevels,
  /// which is returned where no edge is near and where the inside of a face was hit
  Vec3 normal(const Hit& hit, const Vec3& point, const Vec3& smooth) const;

 private:
  /// A convex edge of a face, in the frame of the mesh.
  struct Edge {
    Vec3 from, along;  ///< an end; unit
    double length;
    Vec3 own, other;  ///< outward normals of the face and of the other face
    double reach;     ///< m, how far the fillet extends from the edge along the face
  };
  struct EdgesOfMesh {
    const Mesh* mesh;
    std::vector<Edge> edges;
    std::vector<std::uint32_t> first, near;  ///< edges near triangle t: near[first[t]] to near[first[t + 1] - 1]
  };
  std::shared_ptr<const EdgesOfMesh> edges_of(const Mesh& mesh, const std::vector<Scenery::Plane>& planes) const;

  double radius_;
  struct Body {
    std::shared_ptr<const EdgesOfMesh> edges;  ///< null: it has no fillets
    const std::vector<Scenery::Plane>* planes = nullptr;
    Pose pose;
  };
  std::vector<Body> bodies_;
};

}  // namespace bin_scenes
