#include "tool/progress_bar.hpp"

#include <unistd.h>

#include <cstdio>
#include <string>

namespace bin_scenes {

namespace {
constexpr int bar_width = 20;                    ///< characters; leaves room for the text in 80 columns
constexpr std::chrono::milliseconds pause(100);  ///< between two updates: a terminal is slow
}  // namespace

ProgressBar::ProgressBar() : terminal_(::isatty(STDERR_FILENO) == 1) {}
ProgressBar::~ProgressBar() {
  clear();
}

void ProgressBar::show(const Progress& progress) {
  const auto now = std::chrono::steady_clock::now();
  if (!terminal_ || (shown_ && now - last_ < pause)) return;
  last_ = now;
  shown_ = true;
  const int full = static_cast<int>(progress.fraction * bar_width);
  const std::string bar = std::string(full, '#') + std::string(bar_width - full, '.');
  // Without wrapping (?7l), so that a narrow terminal cuts the line and has but one to clear.
  std::fprintf(stderr, "\r\033[K\033[?7l[%s] scene %zu %s", bar.c_str(), progress.scene, progress.phase.c_str());
  if (progress.simulated_s > 0) {  // other phases know nothing of rest
    std::fprintf(stderr, ": %zu of %zu parts at rest, %.2f s", progress.resting, progress.parts, progress.simulated_s);
  }
  std::fputs("\033[?7h", stderr);
  std::fflush(stderr);
}

void ProgressBar::clear() {
  if (shown_) std::fputs("\r\033[K", stderr);
  shown_ = false;
}

}  // namespace bin_scenes
