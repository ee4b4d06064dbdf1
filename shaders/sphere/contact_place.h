// Places of contacts. A manifold's contacts are a chain through those of its world, and so are the places that nobody
// has. Which place a contact gets never matters to a result. find_contacts takes places and gives others up, all at
// once: what it gives up is a chain of its own until find_pairs joins the two, so that a place taken from one end of a
// chain is never put back while another group still looks at it. Needs the bindings Progress, Manifolds and Contacts.

uint first_contact(SphereWorld world, uint slot) {
  return world.contacts.x + manifolds[world.pairs.x + slot].state.w;
}
// How many of its contacts are solved in this step: the first ones.
uint solved_contacts(SphereWorld world, uint slot) {
  return manifolds[world.pairs.x + slot].solved;
}
uint place_after(SphereWorld world, uint place) { return contacts[world.contacts.x + place].next; }
uint next_contact(SphereWorld world, uint contact) {
  return world.contacts.x + place_after(world, contact - world.contacts.x);
}
void link_places(SphereWorld world, uint place, uint next) {
  contacts[world.contacts.x + place].next = next;
}

// find_pairs, one invocation, before any manifold is retired: what find_contacts gave up is free again.
void take_back_places(SphereWorld world, uint w) {
  if (progress[w].released_contact == SPHERE_NO_PLACE) return;
  link_places(world, progress[w].last_released, progress[w].free_contact);
  progress[w].free_contact = progress[w].released_contact;
  progress[w].released_contact = SPHERE_NO_PLACE;
}

// find_pairs: the places of a manifold's contacts are free.
void retire_places(SphereWorld world, uint w, uint slot) {
  uint count = manifolds[world.pairs.x + slot].state.x, first = manifolds[world.pairs.x + slot].state.w, last = first;
  if (count == 0u) return;
  for (uint k = 1u; k < count; ++k) last = place_after(world, last);
  link_places(world, last, atomicExchange(progress[w].free_contact, first));
}
