/// BIN_SCENES_ASSERT(condition) states an invariant at the place where it holds. Every build contains the assertions,
/// so that tests and users run the same code. They are evaluated only if the environment variable BIN_SCENES_ASSERTIONS
/// is set, as all tests set it; otherwise an assertion costs one branch, and inner loops contain none. If a condition
/// is violated, its text, file and line are printed, and the process aborts. Assertions detect mistakes in this
/// library. Mistakes of users are reported with Error (core/error.hpp).
#pragma once

#include "bin_scenes/core/types.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>

namespace bin_scenes {

/// Whether BIN_SCENES_ASSERTIONS was set when the process started.
extern const bool assertions_on;

/// The work of a thread, for the message of a failed assertion. -1: unknown or, for `b`, the bin.
struct AssertionPlace {
  std::int64_t scene = -1;      ///< index of the scene
  std::int64_t step = -1;       ///< number of the solver's step, from 1
  std::int64_t a = -1, b = -1;  ///< the pair of parts or bodies
};

/// Sets the place of this thread until the end of the scope, if assertions are on. Values of -1 keep those of the
/// enclosing scope.
class AssertionScope {
 public:
  explicit AssertionScope(const AssertionPlace& place) {
    if (assertions_on) enter(place);
  }
  ~AssertionScope() {
    if (assertions_on) leave();
  }
  AssertionScope(const AssertionScope&) = delete;
  AssertionScope& operator=(const AssertionScope&) = delete;

 private:
  void enter(const AssertionPlace& place);
  void leave();
  AssertionPlace outer_;
};

/// Prints the condition, its place, and the scene and pair that are being worked on, and aborts.
[[noreturn]] void assertion_failed(const char* condition, const char* file, int line);

#define BIN_SCENES_ASSERT(...)                                          \
  do {                                                                  \
    if (::bin_scenes::assertions_on && !(__VA_ARGS__))                  \
      ::bin_scenes::assertion_failed(#__VA_ARGS__, __FILE__, __LINE__); \
  } while (false)

/// Whether the length is 1. The squared length may differ from 1 by 1e-6.
inline bool is_unit(const Quat& q) {
  return std::abs(q.squaredNorm() - 1.0) < 1e-6;
}
inline bool is_unit(const Vec3& v) {
  return std::abs(v.squaredNorm() - 1.0) < 1e-6;
}
/// Whether the pose is finite and its orientation has unit length.
inline bool is_rigid(const Pose& pose) {
  return pose.finite() && is_unit(pose.orientation);
}

/// Whether the condition is true for every item.
template <class Items, class Condition>
bool each_is(const Items& items, Condition&& condition) {
  return std::all_of(std::begin(items), std::end(items), condition);
}
/// Whether each item is greater than the one before it.
template <class Items>
bool ascends(const Items& items) {
  return std::adjacent_find(std::begin(items), std::end(items),
                            [](const auto& a, const auto& b) { return !(a < b); }) == std::end(items);
}

}  // namespace bin_scenes
