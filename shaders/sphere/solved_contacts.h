// Which contacts of a manifold are solved in a step: those that press already, and those no farther apart than they may
// close in the step. They come first in its chain, else in the order they had. Twin: put_solved_first(). Needs the
// bindings Settings, Bodies, States, Shapes, Manifolds, Contacts, sphere/pair.h and sphere/contact_place.h.

#include "sphere/contact_gap.h"

// Returns how many they are.
uint put_solved_first(SphereWorld world, SpherePair pair) {
  uint slot = world.pairs.x + pair.slot, count = manifolds[slot].state.x, solved = 0u;
  float reach = settings.press_margin * size_of(pair) + way_of(world, pair);
  uint first = SPHERE_NO_PLACE, last = SPHERE_NO_PLACE, first_left = SPHERE_NO_PLACE, last_left = SPHERE_NO_PLACE;
  for (uint i = 0u, place = manifolds[slot].state.w, next; i < count; ++i, place = next) {
    next = place_after(world, place);
    SphereContact c = contacts[world.contacts.x + place];
    if (c.force.x > 0.0 || separation_of(c, pair) <= reach) {
      if (solved++ == 0u)
        first = place;
      else
        link_places(world, last, place);
      last = place;
    } else {
      if (first_left == SPHERE_NO_PLACE)
        first_left = place;
      else
        link_places(world, last_left, place);
      last_left = place;
    }
  }
  if (solved > 0u && solved < count) link_places(world, last, first_left);
  if (count > 0u) manifolds[slot].state.w = solved > 0u ? first : first_left;
  manifolds[slot].solved = solved;
  return solved;
}

// Contacts of a pair in this step, and how many of them are solved: none where nothing moves.
uvec2 contacts_to_solve(SphereWorld world, SpherePair pair) {
  if (!moves(pair.a) && (pair.b == SPHERE_GROUND || !moves(pair.b))) return uvec2(0u);
  uint solved = put_solved_first(world, pair);
  return uvec2(manifolds[world.pairs.x + pair.slot].state.x, solved);
}
