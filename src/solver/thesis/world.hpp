/// One world as the solver `thesis` stores it between two advances: shapes, present bodies, and their motion.
/// passes.hpp simulates it on a device, and twin.hpp simulates it on the CPU.
#pragma once

#include "bin_scenes/part/mass_properties.hpp"
#include "bin_scenes/part/spheres.hpp"
#include "bin_scenes/scene/report.hpp"
#include "bin_scenes/scene/request.hpp"
#include "bin_scenes/solver/solver.hpp"
#include "shared/thesis.h"

#include <vector>

namespace bin_scenes::thesis {

inline gpu::vec4 vec4(const Vec3& v, double w = 0.0) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z()), static_cast<float>(w)};
}

/// A part that is represented by spheres. Positions are relative to its centre of mass, in its principal axes.
struct Shape {
  std::vector<Sphere> spheres;
  Vec3 gyration = Vec3::Ones();  ///< principal moments of inertia / mass (m2)
  Pose frame;                    ///< from the principal axes to the model frame
  double radius = 0.0;           ///< radius of the bounding sphere around the centre of mass (m)
};

/// Makes a shape from given spheres (model frame) with the mass properties of the true mesh.
Shape make_shape(const std::vector<Sphere>& spheres, const MassProperties& mass);

struct World {
  std::vector<Shape> shapes;  ///< index: BodyDef::part
  std::vector<BodyDef> bodies;
  Vec3 gravity = Vec3(0.0, 0.0, -9.81);
  std::vector<gpu::ThesisSheet> sheets;  ///< planes of the bin
  std::vector<Sphere> bin_spheres;       ///< spheres of a bin that is a mesh, in the bin frame
  double bin_friction = 0.5, bin_restitution = 0.0;
  Aabb domain;  ///< largest region of the collision grid; empty: the grid includes all bodies

  std::vector<gpu::ThesisState> states;  ///< index: body
  std::vector<bool> present;
  std::uint64_t steps = 0;
  std::size_t contacts_need = 0, neighbours_need = 0;  ///< most contacts of a sphere, and most neighbours of a body
  bool contacts_dropped = false;
};

/// Makes a world without present bodies, in which a box and a floor are sheets. The caller adds the spheres of a mesh
/// bin.
World make_world(const WorldDef& def, const std::vector<Shape>& shapes, const ThesisSettings& settings);

gpu::ThesisState to_state(const BodyState& state, const Shape& shape);
BodyState to_body_state(const gpu::ThesisState& state, const Shape& shape);

/// Returns the sheets of floor and walls of a box, or of the floor only. The floor pushes bodies back from any depth;
/// walls push them back from within 8 sphere radii or two wall thicknesses, so that bodies outside are not drawn in.
/// @param radius  radius of the lattice's spheres (m), which touch the planes of the bin from outside
/// @param tightness  distance of neighbouring spheres / (2 radius)
std::vector<gpu::ThesisSheet> bin_sheets(const Bin& bin, double wall_height, double radius, double tightness);

}  // namespace bin_scenes::thesis
