/// The collision shape of a part for the default sphere solver: contact samples to be tested against other parts'
/// distance fields, and its own distance field. All in the body frame: origin at the centre of mass, model axes.
#pragma once

#include "solver/sphere/shapes/contact_samples.hpp"
#include "solver/sphere/shapes/field.hpp"

namespace bin_scenes::sphere {

struct Shape {
  Samples coarse, fine;
  Field field;
  Vec3f center = Vec3f::Zero();      ///< centre of mass in the model frame
  Vec3f box_center = Vec3f::Zero();  ///< centre of the bounding box, body frame
  Vec3f box_half = Vec3f::Zero();
  float radius = 0;     ///< largest node distance from the centre of mass
  float diagonal = 0;   ///< m, of the model's bounding box
  float size = 0;       ///< m that lengths at contacts follow from: the diagonal, at most 50 thicknesses
  float thickness = 0;  ///< 2 volume / area: of a sheet, and less than the width of anything thicker
  float wall = 0;       ///< m: of a slender rod its wall_thickness(), up to twice `thickness`; else `thickness`
  Mat3f unit_inertia = Mat3f::Identity();  ///< at mass 1, body frame
  std::vector<Flag> flags;                 ///< remarks for the user
};

/// Collision shape of a part; `coarse` and `fine` are the numbers of nodes aimed at. The field's cell is `field_cell`
/// of the diagonal, or as large as `field_nodes` ask.
Shape make_shape(const PartModel& part, int coarse, int fine, double field_cell,
                 std::size_t field_nodes = FieldOptions().max_nodes);

}  // namespace bin_scenes::sphere
