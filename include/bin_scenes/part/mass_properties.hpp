/// Volume, centre of mass and inertia of a closed mesh, by exact integrals over its surface. Solvers scale them by the
/// mass of a part; drift, rest and symmetries use the centre of mass and the principal axes.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"

namespace bin_scenes {

/// Mass properties at a density of 1 kg/m3, in the model frame.
struct MassProperties {
  double volume = 0.0;          ///< volume (m3)
  double area = 0.0;            ///< surface area (m2)
  Vec3 center = Vec3::Zero();   ///< centre of mass (m)
  Mat3 inertia = Mat3::Zero();  ///< inertia tensor (kg m2) about the centre of mass, along the axes of the model frame
  Vec3 principal = Vec3::Zero();           ///< principal moments of inertia (kg m2), ascending
  Quat principal_axes = Quat::Identity();  ///< rotation from principal axes to the model frame; its columns are the
                                           ///< principal axes, right-handed
};

/// Computes the mass properties by signed tetrahedra (Eberly 2002) after Mirtich 1996, "Fast and accurate computation
/// of polyhedral mass properties". The result is exact for every closed mesh, also for concave and hollow ones.
MassProperties mass_properties(const Mesh& mesh);

}  // namespace bin_scenes
