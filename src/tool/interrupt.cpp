#include "tool/interrupt.hpp"

#include "tool/commands.hpp"

#include <sys/time.h>
#include <unistd.h>

#include <csignal>
#include <cstring>

namespace bin_scenes {

namespace {

// A signal's handler reaches nothing but globals.
std::atomic<bool> interrupted{false};
const char* words = nullptr;
suseconds_t patience = 0;

void give_up(int) {
  if (words) static_cast<void>(!write(STDERR_FILENO, words, std::strlen(words)));
  _exit(exit_interrupted);
}

void stop(int) {
  if (interrupted.exchange(true)) give_up(0);  // asked twice
  std::signal(SIGALRM, give_up);
  const itimerval once{{0, 0}, {0, patience}};
  setitimer(ITIMER_REAL, &once, nullptr);
}

}  // namespace

const std::atomic<bool>& stop_on_signals(suseconds_t patience_us, const char* last_words) {
  patience = patience_us;
  words = last_words;
  std::signal(SIGINT, stop);
  std::signal(SIGTERM, stop);
  return interrupted;
}

}  // namespace bin_scenes
