/// Finds the connected components (shells) of a mesh. A part that is made of several solids has several shells. Convex
/// hulls and surface samples are made for each shell.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"

#include <cstdint>
#include <vector>

namespace bin_scenes {

/// The shell of each triangle: triangles that share a vertex are in one shell. Shells are numbered by first triangle.
struct Shells {
  std::vector<std::uint32_t> of_triangle;
  std::size_t count = 0;
};
Shells shells_of(const Mesh& mesh);

}  // namespace bin_scenes
