/// Shades edges as if they were rounded. Edges of CAD models are sharp; those of real parts have a bevel or fillet that
/// shines along the whole edge. Near a convex edge, the normal is that of a fillet between both faces, where the
/// bisector of the faces through the point meets it. Outlines and depth stay those of the mesh.
#pragma once

#include "bin_scenes/raster/scenery.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace bin_scenes {

class Bevels {
 public:
  /// @param radius  radius of all fillets (m)
  Bevels(const Scenery& scenery, double radius);
  /// Returns the unit normal (bin frame) for shading a point on a part that was hit. @param smooth  its normal without
  /// bevels, which is returned if no edge is near or if the inner side of a face was hit
  Vec3 normal(const Hit& hit, const Vec3& point, const Vec3& smooth) const;

 private:
  /// A convex edge of a face, in the frame of the mesh.
  struct Edge {
    Vec3 from, along;  ///< one end of the edge; unit direction from there
    double length;
    Vec3 own, other;  ///< outward unit normals of the face to which this edge belongs, and of the other face
    double reach;     ///< m, distance from the edge up to which the fillet extends along the face
  };
  struct EdgesOfMesh {
    const Mesh* mesh;
    std::vector<Edge> edges;
    std::vector<std::uint32_t> first, near;  ///< edges near triangle t: near[first[t]] to near[first[t + 1] - 1]
  };
  std::shared_ptr<const EdgesOfMesh> edges_of(const Mesh& mesh, const std::vector<Scenery::Plane>& planes) const;

  double radius_;
  struct Body {
    std::shared_ptr<const EdgesOfMesh> edges;  ///< null: the body has no fillets
    const std::vector<Scenery::Plane>* planes = nullptr;
    Pose pose;
  };
  std::vector<Body> bodies_;
};

}  // namespace bin_scenes
