/// The default solver as passes on the GPU, many worlds at once. Its passes on the CPU (solver/sphere) say what it
/// computes; results agree in their statistics, not bit for bit.
#pragma once

#include "bin_scenes/solver/solver.hpp"

namespace bin_scenes {

namespace sphere_gl {
/// Sizes that cost time, no result. Lists grow: too small a one costs a repeated step.
struct Capacity {
  std::size_t pairs = 4;            ///< of bodies near each other, per body of a world
  std::size_t rows = 12;            ///< of contacts that are solved, per body of a world
  std::size_t candidates = 4;       ///< and samples that they come from, per pair that there is room for
  std::size_t most_candidates = 0;  ///< of one step; 0: as many as fit a quarter of `memory`
  std::size_t bodies = 0;           ///< expected in a world; the more, the fewer worlds at once
  double memory = 1e9;              ///< bytes on the device for the worlds that run at once
  std::size_t group_bodies = 384;   ///< a world of more is spread over many groups; at most SPHERE_MAX_BODIES
  std::size_t world_group = 0;      ///< invocations that share such a world; 0: 64 on a software device, else 256
  std::size_t pair_group = 0;       ///< invocations that find contacts of a pair; 0: 64 on a software device, else 32
  bool share_impacts = true;        ///< such a world sweeps until impacts are shared; larger ones never do
  std::size_t rounds = 24;          ///< of coloring that a large world has dispatches for; others share one group
  std::size_t colors = 32;          ///< of a large world that may have dispatches of their own; others share a group
  bool as_on_card = false;          ///< a software device is used like a card, whose passes test/meter counts
};

/// Largest Capacity::group_bodies on a software device. A group that pressed 358 bodies in a heap of random overlaps
/// returned wrong velocities on llvmpipe silently; its limit on loop iterations is the suspected cause
/// (docs/develop/gpu.md, "Limits"). A group of 160 such bodies is right.
constexpr std::size_t software_group_bodies = 192;

/// As many worlds as fit into memory, with no list beyond half of what the driver allows for a buffer, since lists
/// grow. At most 1,024 of one group each, and 256 of several, which take steps one after the other; 4 on a software
/// device.
std::size_t worlds_at_once(const Capacity& capacity, std::size_t storage_bytes, bool software);
}  // namespace sphere_gl

/// Bodies that a world may have, fixed ones and a mesh bin among them.
std::size_t most_gl_bodies();

/// Needs a GL device on this thread; throws an environment Error without one.
std::unique_ptr<Solver> make_gl_sphere_solver(const SphereSettings& settings, const sphere_gl::Capacity& capacity = {});

}  // namespace bin_scenes
