// Which contacts of a manifold are solved in a step: those that press already, and those no farther apart than they may
// close in the step. They come first, else in the order they had. Twin: put_solved_first(). Needs the bindings Settings,
// Bodies, States, Shapes, Manifolds, Contacts and sphere/pair.h.

#include "sphere/contact_gap.h"

// Returns how many they are.
uint put_solved_first(SphereWorld world, SpherePair pair) {
  uint slot = world.pairs.x + pair.slot, first = SPHERE_MAX_CONTACTS * slot, count = manifolds[slot].state.x, solved = 0u;
  float reach = settings.press_margin * size_of(pair) + way_of(world, pair);
  for (uint k = 0u; k < count; ++k) {
    SphereContact c = contacts[first + k];
    if (c.force.x <= 0.0 && separation_of(c, pair) > reach) continue;
    for (uint i = k; i > solved; --i) contacts[first + i] = contacts[first + i - 1u];
    if (k > solved) contacts[first + solved] = c;
    ++solved;
  }
  manifolds[slot].solved = solved;
  return solved;
}

// Contacts of a pair in this step, and how many of them are solved: none where nothing moves.
uvec2 contacts_to_solve(SphereWorld world, SpherePair pair) {
  if (!moves(pair.a) && (pair.b == SPHERE_GROUND || !moves(pair.b))) return uvec2(0u);
  uint solved = put_solved_first(world, pair);
  return uvec2(manifolds[world.pairs.x + pair.slot].state.x, solved);
}
