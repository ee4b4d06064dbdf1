/// The default solver as passes on the GPU, for many worlds at once. The passes on the CPU (solver/sphere) are its
/// specification. The statistics of the results agree, but the results are not equal bit for bit.
#pragma once

#include "bin_scenes/solver/solver.hpp"

namespace bin_scenes {

namespace sphere_gl {
/// Sizes that cost time, no result. Lists grow: too small a one costs a repeated step.
struct Capacity {
  std::size_t pairs = 4;            ///< of bodies near each other, per body of a world
  std::size_t rows = 17;            ///< of contacts that are solved, per body of a world
  std::size_t candidates = 4;       ///< and samples that they come from, per pair that there is room for
  std::size_t most_candidates = 0;  ///< of one step; 0: as many as fit a quarter of `memory`
  std::size_t bodies = 0;           ///< expected in a world; the more, the fewer worlds at once
  double memory = 1e9;              ///< bytes on the device for the worlds that run at once
  std::size_t group_bodies = 0;     ///< most of a world; 0: as many as the device can do, at most SPHERE_MAX_BODIES
  std::size_t world_group = 0;      ///< invocations that share a world; 0: 64 on a software device, else 256
  std::size_t pair_group = 0;       ///< invocations that find contacts of a pair; 0: 64 on a software device, else 32
  bool as_on_card = false;          ///< a software device is used like a card, whose passes test/meter counts
};

/// Most bodies of a world on a software device. A group that pressed 358 bodies in a heap of random overlaps
/// returned wrong velocities on llvmpipe silently; its limit on loop iterations is the suspected cause
/// (docs/develop/gpu.md, "Limits"). A group of 160 such bodies is right.
constexpr std::size_t software_group_bodies = 192;

/// As many worlds as fit into memory, with no list beyond half of what the driver allows for a buffer, since lists
/// grow. At most 1,024; 4 on a software device.
std::size_t worlds_at_once(const Capacity& capacity, std::size_t storage_bytes, bool software);
}  // namespace sphere_gl

/// Bodies that a world may have on a GPU, fixed ones and a mesh bin among them: the velocities of more do not fit the
/// shared memory of one work group. The passes of several groups that once ran larger worlds needed 74 dispatches a
/// step and 5 to 13 more a sweep, one world after the other: docs/develop/gpu.md, "Large worlds".
std::size_t most_gl_bodies();

/// Needs a GL device on this thread; throws an environment Error without one.
std::unique_ptr<Solver> make_gl_sphere_solver(const SphereSettings& settings, const sphere_gl::Capacity& capacity = {});

}  // namespace bin_scenes
