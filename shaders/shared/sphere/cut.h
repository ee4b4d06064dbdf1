// Steps are cut for as long as something is fast: parts would fly through each other, and contacts would pull at levers
// that have long turned away.
const float LONGEST_MOVE = 1.0f;   // of the fastest part in one step: thicknesses of the thinnest part
const float LONGEST_TURN = 0.4f;   // rad; beyond, also
const float TURN_OF_A_CUT = 0.1f;  // rad: keeps a tumbling part's energy and angular momentum
const float MOST_CUTS = 64.0f;

// Cuts of a step in which no surface moves farther than `distance` (m) and nothing turns by more than `turn` (rad).
INLINE uint cuts_of(float distance, float turn, float thinnest) {
  float cuts = max(1.0f, distance / (LONGEST_MOVE * thinnest));
  if (turn > LONGEST_TURN) cuts = max(cuts, turn / TURN_OF_A_CUT);
  return uint(ceil(min(cuts, MOST_CUTS)));
}
