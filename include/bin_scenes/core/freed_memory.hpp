/// Reuse of freed memory by a program that makes many images.
#pragma once

namespace bin_scenes {

/// Makes the C library keep up to 256 MB of freed memory in this process, so that the next images reuse it. Images of a
/// megapixel are blocks of 1 to 16 MB. By default the C library returns such blocks to the system at once, and each new
/// image waits until the system has cleared them again, which takes a fifth of the time of a structured-light image.
/// A program calls this function before it starts its first thread; the library itself leaves the choice to the
/// program.
void keep_freed_memory();

}  // namespace bin_scenes
