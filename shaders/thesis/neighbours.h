// Returns the slot for a neighbour in a body's hash table, which counts its contacts with each neighbour. It replaces
// the M x M matrix of the thesis, where M is the number of bodies. Slots depend on the order of arrival, counts do not.
uint neighbour_slot(uint body, uint key, uint probe) {
  uint slots = settings.neighbour_slots;
  return body * slots + ((((key * 2654435761u) >> 16) + probe) & (slots - 1u));
}
