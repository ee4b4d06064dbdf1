#include "bin_scenes/core/assertion.hpp"

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

namespace bin_scenes {

namespace {

AssertionPlace& place_of_thread() {
  static thread_local AssertionPlace place;
  return place;
}

/// " in scene 3, step 120, pair 4 and 7", as far as known.
std::string words(const AssertionPlace& place) {
  std::string text;
  const auto add = [&](const std::string& more) { text += (text.empty() ? " in " : ", ") + more; };
  if (place.scene >= 0) add("scene " + std::to_string(place.scene));
  if (place.step >= 0) add("step " + std::to_string(place.step));
  if (place.a >= 0)
    add("pair " + std::to_string(place.a) + " and " + (place.b < 0 ? "the bin" : std::to_string(place.b)));
  return text;
}

}  // namespace

const bool assertions_on = std::getenv("BIN_SCENES_ASSERTIONS") != nullptr;

void AssertionScope::enter(const AssertionPlace& place) {
  AssertionPlace& now = place_of_thread();
  outer_ = now;
  if (place.scene >= 0) now.scene = place.scene;
  if (place.step >= 0) now.step = place.step;
  if (place.a >= 0) now.a = place.a, now.b = place.b;
}

void AssertionScope::leave() {
  place_of_thread() = outer_;
}

void assertion_failed(const char* condition, const char* file, int line) {
  const char* slash = std::strrchr(file, '/');
  std::fprintf(stderr, "bin_scenes: assertion failed: %s (%s:%d)%s\n", condition, slash ? slash + 1 : file, line,
               words(place_of_thread()).c_str());
  std::abort();
}

}  // namespace bin_scenes
