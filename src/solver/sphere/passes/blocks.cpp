#include "solver/sphere/passes/blocks.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "solver/sphere/passes/counting_sort.hpp"

namespace bin_scenes::sphere {

void Blocks::join(const World& world) {
  groups_.reset(world.bodies.size());
  for (const std::uint32_t i : world.order) {
    const Manifold& m = world.manifolds[i];
    if (m.b == ground || !world.bodies[m.a].moves() || !world.bodies[m.b].moves()) continue;
    groups_.join(m.a, m.b);
  }
  if (world.jaws) groups_.join(world.jaws->first, world.jaws->second);
}

/// Fills block_ with whole groups of joined bodies, in the order of their lowest; returns how many blocks there are.
std::uint32_t Blocks::number(const World& world, std::size_t bodies_of_block) {
  const std::size_t count = world.bodies.size();
  block_.assign(count, 0);
  if (count <= bodies_of_block) return 1;
  join(world);
  place_.assign(count, 0);  // here: bodies of a group
  for (std::uint32_t i = 0; i < count; ++i) place_[groups_.root(i)] += world.bodies[i].moves();
  std::uint32_t block = 0;
  std::size_t held = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (groups_.root(i) != i) {
      block_[i] = block_[groups_.root(i)];
      continue;
    }
    if (held >= bodies_of_block) {
      ++block;
      held = 0;
    }
    block_[i] = block;
    held += place_[i];
  }
  return block + 1;
}

void Blocks::make(const World& world, std::size_t bodies_of_block) {
  const std::uint32_t blocks = number(world, bodies_of_block);
  BIN_SCENES_ASSERT(blocks >= 1 && each_is(block_, [&](std::uint32_t block) { return block < blocks; }));
  moving_.clear();
  for (std::uint32_t i = 0; i < world.bodies.size(); ++i)
    if (world.bodies[i].moves()) moving_.push_back(i);
  const auto block_of_body = [&](std::uint32_t body) { return block_[body]; };
  counting_sort(moving_, blocks, block_of_body, body_start_, bodies_);
  const auto block_of = [&](std::uint32_t manifold) {
    const Manifold& m = world.manifolds[manifold];
    return block_[world.bodies[m.a].moves() ? m.a : m.b];
  };
  counting_sort(world.order, blocks, block_of, manifold_start_, manifolds_);
  BIN_SCENES_ASSERT(bodies_.size() == moving_.size() && manifolds_.size() == world.order.size());
  place_.assign(world.bodies.size(), unmoved);
  for (std::size_t block = 0; block < blocks; ++block) {
    const Slice bodies = this->bodies(block);
    BIN_SCENES_ASSERT(ascends(bodies));
    for (std::uint32_t k = 0; k < bodies.size(); ++k) place_[bodies[k]] = k;
  }
}

}  // namespace bin_scenes::sphere
