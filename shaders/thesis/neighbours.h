// A small hash table per body: how many contacts it has with each of its neighbours. It stands for the thesis's M x M
// matrix, which grows with the square of the bodies. Slots depend on arrival, counts do not.
uint neighbour_slot(uint body, uint key, uint probe) {
  uint slots = settings.neighbour_slots;
  return body * slots + ((((key * 2654435761u) >> 16) + probe) & (slots - 1u));
}
