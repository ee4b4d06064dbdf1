/// Reuse of freed memory by programs that make many images. The setting concerns the C library's allocator and
/// therefore the whole process, which is why only programs make it, and the library never does.
#pragma once

namespace bin_scenes {

/// Makes the C library keep up to 256 MB of freed memory in this process, so that the next images reuse it. Images of a
/// megapixel are blocks of 1 to 16 MB. By default the C library returns such blocks to the system at once, and each new
/// image waits until the system has cleared them again, which takes a fifth of the time of a structured-light image. A
/// program calls this function before it starts its first thread.
void keep_freed_memory();

}  // namespace bin_scenes
