/// Makes the default solver `sphere` on the CPU: surface samples of one part are tested against the distance field of
/// the other, and sub-stepped soft contacts are solved. The passes are in passes/, and the GPU form is in
/// solver/sphere_gl.
#pragma once

#include "bin_scenes/solver/solver.hpp"

namespace bin_scenes {

namespace sphere {
struct Variant;  // make_world.hpp
}

std::unique_ptr<Solver> make_sphere_solver(const SphereSettings& settings);
std::unique_ptr<Solver> make_sphere_solver(const SphereSettings& settings, const sphere::Variant& variant);

}  // namespace bin_scenes
