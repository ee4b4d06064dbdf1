/// The default solver as passes on the GPU, for many worlds at once. The passes on the CPU (solver/sphere) are its
/// specification. The statistics of the results agree, but the results are not equal bit for bit.
#pragma once

#include "bin_scenes/solver/solver.hpp"

namespace bin_scenes {

namespace sphere_gl {
/// Sizes that influence the time of computation but not the results. Lists grow: if one is too small, a step is
/// repeated.
struct Capacity {
  std::size_t pairs = 4;            ///< initial room for pairs of bodies near each other, per body of a world
  std::size_t rows = 17;            ///< initial room for rows (SphereOrdered) of contacts, per body of a world
  std::size_t candidates = 4;       ///< initial room for candidates, and for samples near a part, per pair
  std::size_t most_candidates = 0;  ///< largest length of these lists; 0: what a quarter of `memory` can hold
  std::size_t bodies = 0;           ///< expected number of bodies of a world; with more, fewer worlds run at once
  double memory = 1e9;              ///< bytes on the device for the worlds that run at the same time
  /// Largest number of bodies of a world; 0: as many as the device can hold, at most SPHERE_MAX_BODIES.
  std::size_t group_bodies = 0;
  /// Number of invocations that process a world together; 0: 64 on a software device, otherwise 256.
  std::size_t world_group = 0;
  /// Number of invocations in a work group that finds contacts; 0: 64 on a software device, otherwise 32.
  std::size_t pair_group = 0;
  /// Whether a software device uses the group sizes and limits of a graphics card, as test/meter does.
  bool as_on_card = false;
};

/// Largest number of bodies of a world on a software device. A group that pressed 358 bodies in a heap of random
/// overlaps silently returned wrong velocities on llvmpipe; its limit on loop iterations is the suspected cause
/// (docs/develop/gpu.md, "Limits"). A group of 160 such bodies is correct.
constexpr std::size_t software_group_bodies = 192;

/// Returns how many worlds fit into memory. Because lists grow, no list may exceed half of `storage_bytes`, the
/// driver's limit for a buffer. The result is at most 1,024, and 4 on a software device.
std::size_t worlds_at_once(const Capacity& capacity, std::size_t storage_bytes, bool software);
}  // namespace sphere_gl

/// Returns how many bodies a world may have on a GPU, including fixed bodies and a mesh bin: the velocities of more do
/// not fit into the shared memory of one work group. Passes of several groups, which ran larger worlds earlier, needed
/// 74 dispatches per step and 5 to 13 more per sweep, one world after the other: docs/develop/gpu.md, "Large worlds".
std::size_t most_gl_bodies();

/// Makes the solver. Needs a GL device on this thread; throws an environment Error without one.
std::unique_ptr<Solver> make_gl_sphere_solver(const SphereSettings& settings, const sphere_gl::Capacity& capacity = {});

}  // namespace bin_scenes
