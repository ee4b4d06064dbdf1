/// Sharp features of a mesh: the convex edges and corners with which a part touches others first.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"

#include <vector>

namespace bin_scenes {

struct FeatureCorner {
  Vec3 point = Vec3::Zero();
  Vec3 normal = Vec3::Zero();  ///< mean of the faces around it, weighted by their angles at the corner
};

/// A run of sharp edges between two corners (or round a closed loop), as points along it.
struct FeatureCurve {
  std::vector<Vec3> points;   ///< a closed loop repeats its first point at the end
  std::vector<Vec3> normals;  ///< one per segment: mean of its two faces
  bool closed = false;

  double length() const;
};

struct Features {
  std::vector<FeatureCorner> corners;  ///< where sharp edges end, meet or bend
  std::vector<FeatureCurve> curves;
};

/// Edges whose faces turn outwards by more than `sharp_angle` (rad). Edges with one face only (an open mesh) count as
/// sharp; concave edges do not, because nothing touches a part there before it touches a face. Slivers have no
/// reliable normal of their own; they take the normal of the face across their longest edge.
Features sharp_features(const Mesh& mesh, double sharp_angle);

}  // namespace bin_scenes
