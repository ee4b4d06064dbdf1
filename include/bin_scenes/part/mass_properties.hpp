/// Volume, centre of mass and inertia of a closed mesh by exact integrals over its surface.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"

namespace bin_scenes {

/// At density 1 kg/m3, in the model frame.
struct MassProperties {
  double volume = 0.0;                     ///< m3
  double area = 0.0;                       ///< m2
  Vec3 center = Vec3::Zero();              ///< m
  Mat3 inertia = Mat3::Zero();             ///< about the centre, model axes (kg m2 at density 1)
  Vec3 principal = Vec3::Zero();           ///< principal moments, ascending
  Quat principal_axes = Quat::Identity();  ///< columns = principal axes in the model frame, right-handed
};

/// Mirtich 1996 ("Fast and accurate computation of polyhedral mass properties"), in the form of
/// Eberly 2002 (signed tetrahedra). Exact for any closed mesh, concave and hollow included.
MassProperties mass_properties(const Mesh& mesh);

}  // namespace bin_scenes
