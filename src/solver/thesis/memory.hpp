/// What the buffers of the device hold, on the host: filled from worlds before it is loaded, read back by tests, and
/// worked on by the CPU twins of the passes.
///
///     bodies      | world 0 ............ | world 1 ...... |            states, inertias, neighbour counts alike
///     spheres     | moving, world 0 | moving, world 1 | static, world 0 | static, world 1 |
///     contacts    | of the spheres that touch, one after another |      a sphere's own lie at its range
///     neighbours  | body 0: neighbour_slots slots | body 1 | ...         hash tables
///     cells       | world 0: nx ny nz | world 1 | ...                    worlds never share a cell
///
/// Within a world the order is that of its bodies whatever else is loaded, so every choice by id and every sum comes
/// out the same alone and in a batch. The grid follows the bodies: it decides who is looked at, never the result.
#pragma once

#include "world.hpp"

#include <vector>

namespace bin_scenes::thesis {

struct Memory {
  // Data that does not change during the steps.
  gpu::ThesisSettingsBlock settings{};
  std::vector<gpu::ThesisWorld> worlds;
  std::vector<gpu::ThesisSheet> sheets;
  std::vector<gpu::ThesisBody> bodies;
  std::vector<gpu::ThesisShape> shapes;
  std::vector<gpu::ThesisSphere> spheres;
  // What the solver moves.
  std::vector<gpu::ThesisState> states;
  // Data that a step produces.
  std::vector<gpu::ThesisInertia> inertias;
  std::vector<gpu::vec4> centers;  ///< w: radius
  std::vector<gpu::uint> sphere_cells, cell_counts, cell_starts, members;
  std::vector<gpu::ThesisSorted> sorted;
  std::vector<gpu::ThesisRange> contact_ranges;
  std::vector<gpu::ThesisContact> contacts;
  std::vector<gpu::ThesisNeighbour> neighbours;
  std::vector<gpu::uint> neighbour_counts, touching_spheres, touching_bodies;
  std::vector<gpu::ThesisPush> pushes;
  gpu::ThesisStatus status{};
  std::vector<gpu::ThesisNeed> needs;
};

/// Converts between the index of a body in its world and its index in Memory.
struct BodyIndex {
  std::size_t world = 0, body = 0;
};

/// Sizes of the buffers that grow; everything else follows from the worlds.
struct Capacity {
  std::size_t contacts = 4;     ///< largest number for one sphere
  double mean_contacts = 2.0;   ///< mean over all moving spheres, whether they touch or not
  std::size_t neighbours = 32;  ///< per body, power of two
};

/// Lays out the present bodies of the worlds. `horizon`: simulated seconds until the next call (s), for the grid.
/// @param index filled with where each body of Memory came from.
/// @param share of a whole step that the next steps are: a shorter one pushes as fast and bounces as little.
Memory lay_out(const std::vector<const World*>& worlds, const ThesisSettings& settings, const Capacity& capacity,
               double horizon, std::vector<BodyIndex>& index, double share = 1.0);

/// Resizes the arrays of the results of a step to the sizes of the buffers on the device.
void size_scratch(Memory& memory);

/// Returns the size (bytes) of the largest buffer that a world needs, by which a batch is divided.
std::size_t largest_buffer(const World& world, const ThesisSettings& settings, const Capacity& capacity);

}  // namespace bin_scenes::thesis
