/// What a program does with memory that it freed.
#pragma once

namespace bin_scenes {

/// Keeps up to 256 MB of freed memory in this process for its next images. Images of a megapixel are blocks of 1 to
/// 16 MB. By default the C library returns such blocks to the system at once, and each new image waits until the system
/// has cleared them again: a fifth of the time of a structured-light image. For programs to call before their first
/// thread; a library leaves this choice to the program.
void keep_freed_memory();

}  // namespace bin_scenes
