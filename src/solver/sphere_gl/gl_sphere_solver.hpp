/// The default solver as passes on the GPU, many worlds at once. Its passes on the CPU (solver/sphere) say what it
/// computes; results agree in their statistics, not bit for bit.
#pragma once

#include "bin_scenes/solver/solver.hpp"

namespace bin_scenes {

namespace sphere_gl {
/// First sizes of lists that grow; too small costs a repeated step, no result.
struct Capacity {
  std::size_t pairs = 4;       ///< of bodies near each other, per body of a world
  std::size_t contacts = 12;   ///< per body of a world
  std::size_t candidates = 8;  ///< contacts to choose from, per invocation of a group
};
}  // namespace sphere_gl

/// Bodies that a world may have, fixed ones and a mesh bin among them.
std::size_t most_gl_bodies();

/// Needs a GL device on this thread; throws an environment Error without one.
std::unique_ptr<Solver> make_gl_sphere_solver(const SphereSettings& settings, const sphere_gl::Capacity& capacity = {});

}  // namespace bin_scenes
