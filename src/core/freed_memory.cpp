#include "bin_scenes/core/freed_memory.hpp"

#include <malloc.h>

namespace bin_scenes {

void keep_freed_memory() {
  mallopt(M_MMAP_THRESHOLD, 32 << 20);  // the largest that glibc takes
  mallopt(M_TRIM_THRESHOLD, 256 << 20);
}

}  // namespace bin_scenes
