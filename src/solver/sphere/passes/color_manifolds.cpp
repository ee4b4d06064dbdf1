#include "solver/sphere/passes/counting_sort.hpp"

#include "solver/sphere/invariants.hpp"
#include "solver/sphere/world.hpp"

#include <algorithm>

namespace bin_scenes::sphere {

/// Greedy, in key order: a manifold takes the lowest color that neither of its moving bodies has yet.
void color_manifolds(World& world) {
  static thread_local std::vector<std::uint64_t> used;
  static thread_local std::vector<std::uint32_t> solved, start;
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
    m.color = taken == ~std::uint64_t{0} ? SPHERE_COLORS - 1 : __builtin_ctzll(~taken);
    const std::uint64_t bit = std::uint64_t{1} << m.color;
    if (a_moves) used[m.a] |= bit;
    if (b_moves) used[m.b] |= bit;
    colors = std::max(colors, m.color + 1);
  }
  solved.clear();
  for (std::uint32_t i = 0; i < world.manifolds.size(); ++i)
    if (world.manifolds[i].color >= 0) solved.push_back(i);
  const auto key = [&](std::uint32_t i) {
    return world.manifolds[i].color * (max_contacts + 1) + max_contacts -
           static_cast<int>(world.manifolds[i].contacts.size());
  };
  BIN_SCENES_ASSERT(colors <= SPHERE_COLORS && contacts_have_room(world));
  counting_sort(solved, colors * (max_contacts + 1), key, start, world.order);
  BIN_SCENES_ASSERT(world.order.size() == solved.size());
}

}  // namespace bin_scenes::sphere
