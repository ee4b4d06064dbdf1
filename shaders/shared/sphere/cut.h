// Steps are shortened while any body is fast. Otherwise parts would pass through each other, and contacts would act on
// lever arms whose direction has changed since.
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
