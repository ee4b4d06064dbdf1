// How the gyroscopic torque of a spinning body is integrated: in gyroscope.hpp and in sphere/solve_body.h.
const float LEAST_GYRATION = 1e-4f;  // rad: with a smaller rotation in a sub-step, the torque is smaller than rounding
const float FREE_TURN = 0.05f;  // rad: largest rotation of a body that nothing touches in one step of the rule. The
                                // rate at which it precesses is wrong by a share of at most FREE_TURN^2 / 12
const float MOST_FREE_TURNS = 64.0f;  // largest number of steps of the rule in a sub-step

// Returns the number of equal steps of the rule in a sub-step in which a body turns by `turn` (rad).
INLINE int steps_of_free_turn(float turn) {
  return int(ceil(min(max(turn / FREE_TURN, 1.0f), MOST_FREE_TURNS)));
}

// The rule is exact for a body that turns by 2 atan(turn / 2) and not by `turn` (rad; mean spin x time). Returns the
// factor on the time with which it fits a body that turns by `turn`: 2 tan(turn / 2) / turn.
INLINE float time_of_free_turn(float turn) {
  return 1.0f + turn * turn / 12.0f;
}
