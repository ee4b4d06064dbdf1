/// Handles SIGINT and SIGTERM for the commands. The first signal asks the command to stop in an orderly manner, so that
/// no incomplete file is left. A second signal, or too long a wait, ends the program at once.
#pragma once

#include <sys/types.h>

#include <atomic>

namespace bin_scenes {

/// The first of these signals sets the flag that is returned, which asks the job to stop. The second, or the end of the
/// patience, ends the process with exit_interrupted: what does not stop by itself (a driver that compiles, a library
/// that is not ours). Then `last_words` go to standard error; null: nothing.
const std::atomic<bool>& stop_on_signals(suseconds_t patience_us, const char* last_words);

}  // namespace bin_scenes
