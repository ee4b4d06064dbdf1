/// Sharp features of a mesh: the convex edges and corners with which a part touches others first. samples.hpp places
/// contact samples on them, and the default solver tests with them whether its samples miss a feature. Concave edges
/// are not features.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"

#include <vector>

namespace bin_scenes {

/// A corner, in the model frame (m).
struct FeatureCorner {
  Vec3 point = Vec3::Zero();
  Vec3 normal = Vec3::Zero();  ///< mean normal of the faces around the corner, weighted by their angles at the corner
};

/// A sequence of sharp edges between two corners, or around a closed loop, as points along it.
struct FeatureCurve {
  std::vector<Vec3> points;   ///< a closed loop repeats its first point at the end
  std::vector<Vec3> normals;  ///< one for each segment: the mean normal of its two faces
  bool closed = false;

  /// Returns the length of the curve (m).
  double length() const;
};

/// All sharp features of a mesh.
struct Features {
  std::vector<FeatureCorner> corners;  ///< where sharp edges end, meet or bend
  std::vector<FeatureCurve> curves;
};

/// Finds the edges at which the outward normals of the two faces differ by more than `sharp_angle` (rad). Edges with
/// only one face (an open mesh) count as sharp. Concave edges do not count, because nothing touches a part there before
/// it touches a face. The normal of a sliver triangle is unreliable, and the normal of the face across its longest edge
/// is used instead.
Features sharp_features(const Mesh& mesh, double sharp_angle);

}  // namespace bin_scenes
