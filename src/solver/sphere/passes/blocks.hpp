/// Blocks: groups of bodies that can be solved one by one, because no manifold joins moving bodies of two blocks.
/// Blocks give the same bits in any order or in parallel. Repeated sweeps concern the contacts of one block only, which
/// fit into the cache however large a world is.
#pragma once

#include "core/disjoint_sets.hpp"
#include "solver/sphere/world.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace bin_scenes::sphere {

/// A run of consecutive entries of a list.
struct Slice {
  const std::uint32_t *first = nullptr, *last = nullptr;

  const std::uint32_t* begin() const { return first; }
  const std::uint32_t* end() const { return last; }
  std::size_t size() const { return static_cast<std::size_t>(last - first); }
  std::uint32_t operator[](std::size_t i) const { return first[i]; }
};

class Blocks {
 public:
  /// Smallest number of bodies of a block (except the last one), so that bundles are filled.
  static constexpr std::size_t usual_bodies = 256;

  /// Makes blocks from the world's colored manifolds. Memory is kept from one step to the next.
  void make(const World& world, std::size_t bodies_of_block = usual_bodies);

  std::size_t count() const { return body_start_.size() - 1; }
  /// Returns the indices of the moving bodies of a block, in ascending order.
  Slice bodies(std::size_t block) const { return slice(bodies_, body_start_, block); }
  /// Returns the manifolds of a block, sorted by color and then in ascending order.
  Slice manifolds(std::size_t block) const { return slice(manifolds_, manifold_start_, block); }
  /// Returns the index of a body within its block. Static bodies and the ground come after all bodies of `block`.
  std::uint32_t place(std::size_t block, std::uint32_t body) const {
    return body == ground || place_[body] == unmoved ? static_cast<std::uint32_t>(bodies(block).size()) : place_[body];
  }

 private:
  static constexpr std::uint32_t unmoved = 0xffffffffu;
  static Slice slice(const std::vector<std::uint32_t>& list, const std::vector<std::uint32_t>& start, std::size_t i) {
    return {list.data() + start[i], list.data() + start[i + 1]};
  }
  void join(const World& world);
  std::uint32_t number(const World& world, std::size_t bodies_of_block);

  DisjointSets groups_;                ///< groups of bodies that manifolds join
  std::vector<std::uint32_t> moving_;  ///< indices of the moving bodies
  std::vector<std::uint32_t> block_;   ///< by body: index of its block
  std::vector<std::uint32_t> place_;
  std::vector<std::uint32_t> bodies_, body_start_, manifolds_, manifold_start_;
};

}  // namespace bin_scenes::sphere
