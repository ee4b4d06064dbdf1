// Steps are shortened while any body is fast. Otherwise parts would pass through each other, and contacts would act on
// lever arms whose direction has changed since.
const float LONGEST_MOVE = 1.0f;   // largest displacement of the fastest part in one step / thickness of the thinnest
                                   // part
const float LONGEST_TURN = 0.4f;   // rad: largest rotation of a body in a step that is not shortened
const float TURN_OF_A_CUT = 0.1f;  // rad: largest rotation in a shortened step, which conserves the energy and the
                                   // angular momentum of a tumbling part
const float MOST_CUTS = 64.0f;     // largest number of shortened steps for one step

// Returns the number of shorter steps into which a step is divided, so that motion and rotation stay within limits.
// distance (m), turn (rad): largest ones in the undivided step; thinnest: thickness of the thinnest part (m).
INLINE uint cuts_of(float distance, float turn, float thinnest) {
  float cuts = max(1.0f, distance / (LONGEST_MOVE * thinnest));
  if (turn > LONGEST_TURN) cuts = max(cuts, turn / TURN_OF_A_CUT);
  return uint(ceil(min(cuts, MOST_CUTS)));
}
