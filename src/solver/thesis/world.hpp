/// One world as the solver `thesis` stores it between two advances: shapes, present bodies, and their motion.
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

/// A part as spheres about its centre of mass, in its principal axes.
struct Shape {
  std::vector<Sphere> spheres;
  Vec3 gyration = Vec3::Ones();  ///< principal moments / mass (m2)
  Pose frame;                    ///< of the principal axes in the model frame
  double radius = 0.0;           ///< of the bounding sphere about the centre of mass (m)
};

/// Mass properties of the true mesh, spheres as given (model frame).
Shape make_shape(const std::vector<Sphere>& spheres, const MassProperties& mass);
/// Each sphere a point of the same mass, the thesis's eq 2.31; a lone sphere is taken as solid.
Shape make_shape(const std::vector<Sphere>& spheres);

struct World {
  std::vector<Shape> shapes;  ///< by BodyDef::part
  std::vector<BodyDef> bodies;
  Vec3 gravity = Vec3(0.0, 0.0, -9.81);
  std::vector<gpu::ThesisSheet> sheets;  ///< planes of the bin
  std::vector<Sphere> bin_spheres;       ///< of a bin given as a mesh, in the bin frame
  double bin_friction = 0.5, bin_restitution = 0.0;
  Aabb domain;  ///< where a collision grid is worth its cells; empty: wherever the bodies are

  std::vector<gpu::ThesisState> states;  ///< by body
  std::vector<bool> present;
  std::uint64_t steps = 0;
  std::size_t contacts_need = 0, neighbours_need = 0;  ///< most seen by any sphere, any body
  bool contacts_dropped = false;
};

/// All bodies absent, box and floor laid out as sheets; a mesh bin's spheres are the caller's.
World make_world(const WorldDef& def, const std::vector<Shape>& shapes, const ThesisSettings& settings);

gpu::ThesisState to_state(const BodyState& state, const Shape& shape);
BodyState to_body_state(const gpu::ThesisState& state, const Shape& shape);

/// Floor and walls of a box, or the floor alone. The floor pushes back from any depth; walls from within 8 sphere
/// radii or two wall thicknesses, so that what lies outside is not drawn in.
/// @param radius of the lattice's spheres (m); the lattice is 2 radius tightness wide, their tops touch the bin's
/// planes.
std::vector<gpu::ThesisSheet> bin_sheets(const Bin& bin, double wall_height, double radius, double tightness);

}  // namespace bin_scenes::thesis
