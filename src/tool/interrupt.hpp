/// Handles SIGINT and SIGTERM for the commands. The first signal asks the command to stop in an orderly manner, so that
/// no incomplete file is left. A second signal, or too long a wait, ends the program at once.
#pragma once

#include <sys/types.h>

#include <atomic>

namespace bin_scenes {

/// Returns a flag that the first SIGINT or SIGTERM sets, so that the command stops. A second signal, or the end of
/// `patience_us`, ends the process with exit_interrupted, for work that cannot be stopped (a driver that compiles, an
/// external library). `last_words` are then written to standard error; null: nothing is written.
const std::atomic<bool>& stop_on_signals(suseconds_t patience_us, const char* last_words);

}  // namespace bin_scenes
