/// The collision shape of a part for the default sphere solver: contact samples, which are tested against the distance
/// fields of other parts, and its own distance field, all in the body frame (origin: centre of mass; model axes).
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
  float radius = 0;     ///< m: largest distance of a vertex from the centre of mass
  float diagonal = 0;   ///< m: diagonal of the model's bounding box
  float size = 0;       ///< m: reference length of contacts: the diagonal, but at most 50 thicknesses
  float thickness = 0;  ///< m: 2 volume / area, the thickness of a sheet; less than the width of thicker parts
  float wall = 0;       ///< m: wall_thickness() of a slender rod, up to twice `thickness`; else `thickness`
  Mat3f unit_inertia = Mat3f::Identity();  ///< inertia for a mass of 1 kg, body frame (kg m2)
  std::vector<Flag> flags;                 ///< remarks for the user
};

/// Makes the collision shape of a part. `coarse`, `fine`: approximate numbers of nodes. `field_cell`: cell of the field
/// / diagonal; cells are enlarged if the field would have more than `field_nodes` nodes.
Shape make_shape(const PartModel& part, int coarse, int fine, double field_cell,
                 std::size_t field_nodes = FieldOptions().max_nodes);

}  // namespace bin_scenes::sphere
