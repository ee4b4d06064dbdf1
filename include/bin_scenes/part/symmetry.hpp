/// Rotations after which a part looks the same, found on its mesh. Evaluations of poses need them.
#pragma once

#include "bin_scenes/part/part_model.hpp"

#include <vector>

namespace bin_scenes {

/// Model frame, m.
struct Symmetries {
  struct Axis {
    Vec3 direction = Vec3::UnitZ();
    Vec3 point = Vec3::Zero();  ///< on the axis
  };
  std::vector<Axis> continuous;  ///< any angle
  std::vector<Pose> discrete;    ///< maps of the part onto itself, without the identity
};

/// Symmetries, and how exact they are: the largest distance (m) from the surface of a point of the turned surface.
struct SymmetryReport {
  Symmetries symmetries;
  std::vector<double> continuous_error, discrete_error;  ///< by axis, by map
  double limit = 0.0;                                    ///< m: an error up to this is a symmetry
  struct Nearly {
    Vec3 direction = Vec3::UnitZ();
    int order = 0;       ///< 0: any angle
    double error = 0.0;  ///< above the limit, up to three times as much
  };
  std::vector<Nearly> nearly;  ///< axes that miss the limit by little, for instance because of a mark or a chamfer
};

/// Rotations about the centre of mass that move no point of the surface by more than `tolerance` * diagonal away from
/// the surface. The candidates are the principal axes of inertia; where two moments are equal, also axes between them,
/// normals of large faces and directions of far vertices; where all three are equal, also directions of arms. Orders 2
/// to 100 and full turns are tested. A symmetry about any other axis is not found.
SymmetryReport examine_symmetries(const PartModel& part, double tolerance = 0.01);
Symmetries find_symmetries(const PartModel& part, double tolerance = 0.01);

/// Largest distance of two vertices (m).
double diameter(const Mesh& mesh);

}  // namespace bin_scenes
