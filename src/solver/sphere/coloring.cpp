#include "solver/sphere/world.hpp"

#include <algorithm>

namespace bin_scenes::sphere {

/// Greedy, in key order: a manifold takes the lowest color that neither of its moving bodies has yet.
void color_manifolds(World& world) {
  static thread_local std::vector<std::uint64_t> used;
  used.assign(world.bodies.size(), 0);
  int colors = 0;
  for (Manifold& m : world.manifolds) {
    m.color = -1;
    if (m.contacts.empty()) continue;
    Body& a = world.bodies[m.a];
    Body* b = m.b == ground ? nullptr : &world.bodies[m.b];
    const bool a_moves = a.moves(), b_moves = b && b->moves();
    if (!a_moves && !b_moves) continue;
    const std::uint64_t taken = (a_moves ? used[m.a] : 0) | (b_moves ? used[m.b] : 0);
    m.color = taken == ~std::uint64_t{0} ? 63 : __builtin_ctzll(~taken);
    const std::uint64_t bit = std::uint64_t{1} << m.color;
    if (a_moves) used[m.a] |= bit;
    if (b_moves) used[m.b] |= bit;
    colors = std::max(colors, m.color + 1);
  }
  std::vector<std::uint32_t> next(colors + 1, 0);  // of each color in the order
  for (const Manifold& m : world.manifolds)
    if (m.color >= 0) ++next[m.color + 1];
  for (int c = 0; c < colors; ++c) next[c + 1] += next[c];
  world.order.resize(next[colors]);
  for (std::uint32_t i = 0; i < world.manifolds.size(); ++i)
    if (world.manifolds[i].color >= 0) world.order[next[world.manifolds[i].color]++] = i;
}

}  // namespace bin_scenes::sphere
