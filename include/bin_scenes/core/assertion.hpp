/// BIN_SCENES_ASSERT(condition) states an invariant at the place where it holds. Every build contains the assertions,
/// so that tests and users run the same code, but they are evaluated only if the environment variable
/// BIN_SCENES_ASSERTIONS is set, as all tests set it. Otherwise an assertion costs one branch, and none stands in an
/// inner loop. A violated condition is printed with file and line, and the process aborts.
#pragma once

#include "bin_scenes/core/types.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace bin_scenes {

extern const bool assertions_on;
[[noreturn]] void assertion_failed(const char* condition, const char* file, int line);

#define BIN_SCENES_ASSERT(...)                                          \
  do {                                                                  \
    if (::bin_scenes::assertions_on && !(__VA_ARGS__))                  \
      ::bin_scenes::assertion_failed(#__VA_ARGS__, __FILE__, __LINE__); \
  } while (false)

inline bool is_unit(const Quat& q) {
  return std::abs(q.squaredNorm() - 1.0) < 1e-6;
}
inline bool is_unit(const Vec3& v) {
  return std::abs(v.squaredNorm() - 1.0) < 1e-6;
}
inline bool is_rigid(const Pose& pose) {
  return pose.finite() && is_unit(pose.orientation);
}

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
