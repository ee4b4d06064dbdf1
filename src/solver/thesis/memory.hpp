/// Contents of the buffers of the device in the memory of the host. They are made from worlds and uploaded; tests read
/// them back, and the CPU twins of the passes process them.
///
///     bodies      | world 0 ............ | world 1 ...... |            same layout: states, inertias, neighbour counts
///     spheres     | moving, world 0 | moving, world 1 | static, world 0 | static, world 1 |
///     contacts    | of the spheres that touch, one after another |      contact_ranges has the place of each sphere's
///     neighbours  | body 0: neighbour_slots slots | body 1 | ...         hash tables
///     cells       | world 0: nx ny nz | world 1 | ...                    worlds never share a cell
///
/// Within a world, elements are in the order of its bodies, whatever else is loaded. Choices by index and sums are
/// therefore the same alone and in a batch. The collision grid influences which spheres are tested, never the result.
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
  // Data that the solver changes.
  std::vector<gpu::ThesisState> states;
  // Data that a step produces.
  std::vector<gpu::ThesisInertia> inertias;
  std::vector<gpu::vec4> centers;  ///< centres of the spheres in world axes (m); w: radius (m)
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

/// The body of a world from which a body of Memory was made.
struct BodyIndex {
  std::size_t world = 0, body = 0;  ///< index of the world, and of the body in this world
};

/// Sizes of the buffers that grow; all other sizes follow from the worlds.
struct Capacity {
  std::size_t contacts = 4;     ///< largest number of contacts of one sphere
  double mean_contacts = 2.0;   ///< room for contacts / number of moving spheres, whether these touch or not
  std::size_t neighbours = 32;  ///< largest number of neighbours of a body, a power of two
};

/// Returns the buffers for the present bodies of the worlds. `horizon`: simulated time until the next call (s).
/// @param index  becomes the origin of each body of Memory.
/// @param share  length of the next steps / length of a full step; it does not change the bias and the rest velocity
Memory lay_out(const std::vector<const World*>& worlds, const ThesisSettings& settings, const Capacity& capacity,
               double horizon, std::vector<BodyIndex>& index, double share = 1.0);

/// Resizes the arrays of the results of a step to the sizes of the buffers on the device.
void size_scratch(Memory& memory);

/// Returns the size (bytes) of the largest buffer that a world needs; it limits the number of worlds in a batch.
std::size_t largest_buffer(const World& world, const ThesisSettings& settings, const Capacity& capacity);

}  // namespace bin_scenes::thesis
