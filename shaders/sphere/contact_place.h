// Places of contacts. A manifold's contacts are a chain through the contacts of its world; places that nobody has are on
// a stack. Which place a contact gets never matters to a result. The stack's entry k is a word of contact k, whoever
// has that: a buffer of its own would be the 17th of find_contacts, and 16 is what drivers grant. find_contacts takes
// places and gives others up, all at once, so what it gives up waits at the far end until find_pairs has the stack to
// itself. Needs the bindings Manifolds and Contacts.

uint first_contact(SphereWorld world, uint slot) {
  return world.contacts.x + manifolds[world.pairs.x + slot].state.w;
}
uint next_contact(SphereWorld world, uint contact) {
  return world.contacts.x + floatBitsToUint(contacts[contact].anchor_a.w);
}

uint free_place(SphereWorld world, uint entry) {
  return floatBitsToUint(contacts[world.contacts.x + entry].bounce.w);
}
void set_free_place(SphereWorld world, uint entry, uint place) {
  contacts[world.contacts.x + entry].bounce.w = uintBitsToFloat(place);
}
uint released_entry(SphereWorld world, uint n) { return world.contacts.y - 1u - n; }

// Puts the contacts of a manifold on the stack from entry `top` on.
void give_places(SphereWorld world, uint slot, uint top, uint count) {
  for (uint k = 0u, at = first_contact(world, slot); k < count; ++k, at = next_contact(world, at))
    set_free_place(world, top + k, at - world.contacts.x);
}

// What the last find_contacts gave up comes back to the stack; entries that lie where the stack will reach stay.
uint places_to_move(SphereWorld world, uint top, uint released) {
  return min(released, world.contacts.y - released - top);
}
void take_back_place(SphereWorld world, uint top, uint n) {
  set_free_place(world, top + n, free_place(world, released_entry(world, n)));
}
