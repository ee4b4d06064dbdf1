#include "bin_scenes/core/assertion.hpp"

#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace bin_scenes {

const bool assertions_on = std::getenv("BIN_SCENES_ASSERTIONS") != nullptr;

void assertion_failed(const char* condition, const char* file, int line) {
  const char* slash = std::strrchr(file, '/');
  std::fprintf(stderr, "bin_scenes: assertion failed: %s (%s:%d)\n", condition, slash ? slash + 1 : file, line);
  std::abort();
}

}  // namespace bin_scenes
