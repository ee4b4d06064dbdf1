/// Symmetries of a part: rotations after which it looks the same, found on its mesh. BOP's models_info.json contains
/// them, because evaluations of estimated poses need them. Reflections are not considered.
#pragma once

#include "bin_scenes/part/part_model.hpp"

#include <vector>

namespace bin_scenes {

/// The symmetries of a part, in the model frame (m).
struct Symmetries {
  struct Axis {
    Vec3 direction = Vec3::UnitZ();
    Vec3 point = Vec3::Zero();  ///< a point of the axis
  };
  std::vector<Axis> continuous;  ///< axes about which any rotation is a symmetry
  std::vector<Pose> discrete;    ///< transforms that map the part onto itself, without the identity
};

/// Symmetries with their errors. An error is the largest distance (m) of a point of the rotated surface from the
/// surface.
struct SymmetryReport {
  Symmetries symmetries;
  std::vector<double> continuous_error, discrete_error;  ///< error of each axis and of each transform (m)
  double limit = 0.0;  ///< tolerance (m): a rotation with at most this error counts as a symmetry
  struct Nearly {
    Vec3 direction = Vec3::UnitZ();
    int order = 0;       ///< of the rotational symmetry (2: half a turn); 0: any angle
    double error = 0.0;  ///< error (m); more than the limit and at most three times the limit
  };
  std::vector<Nearly> nearly;  ///< axes that miss the limit by little, for instance because of a mark or a chamfer
};

/// Finds rotations about the centre of mass that move no point of the surface away from the surface by more than
/// `tolerance` * diagonal. The candidates are the principal axes of inertia; if two moments are equal, also axes
/// between them, normals of large faces and directions of far vertices; if all three are equal, also directions of
/// protruding arms. Orders 2 to 100 and full rotational symmetry are tested. A symmetry about any other axis is not
/// found.
SymmetryReport examine_symmetries(const PartModel& part, double tolerance = 0.01);
Symmetries find_symmetries(const PartModel& part, double tolerance = 0.01);

/// Returns the largest distance between two vertices (m).
double diameter(const Mesh& mesh);

}  // namespace bin_scenes
