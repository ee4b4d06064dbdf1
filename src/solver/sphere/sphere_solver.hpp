/// The default solver behind the common interface: surface samples of one part against the distance field of the
/// other, sub-stepped soft contacts.
#pragma once

#include "bin_scenes/solver/solver.hpp"

namespace bin_scenes {

std::unique_ptr<Solver> make_sphere_solver(const SphereSettings& settings);

}  // namespace bin_scenes
