/// Draws the line of progress, or writes lines into a file or pipe, from the thread that works or from one of its own.
#include "tool/progress_bar.hpp"

#include "core/formatted.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace bin_scenes {

namespace {

constexpr std::chrono::milliseconds pause(100);   ///< between two updates: a terminal is slow
constexpr std::chrono::milliseconds unseen(500);  ///< of a job: what is done by then needs no bar
constexpr const char* erase_line = "\r\033[K";

bool draws() {
  const char* kind = std::getenv("TERM");
  return ::isatty(STDERR_FILENO) == 1 && kind && *kind && std::strcmp(kind, "dumb") != 0;
}

std::size_t columns_of_terminal() {
  winsize size{};
  return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

bool wants_colors() {  // no-color.org
  const char* no = std::getenv("NO_COLOR");
  return !no || !*no;
}

/// Without stdio, whose locks a forked child could find taken.
void put(const std::string& text) {
  static_cast<void>(!::write(STDERR_FILENO, text.data(), text.size()));
}

/// s between lines in a file or pipe; 0: none.
double seconds_between_lines() {
  constexpr double usual = 30.0;
  const char* given = std::getenv("BIN_SCENES_PROGRESS");
  if (!given || !*given) return usual;
  char* end = nullptr;
  const double value = std::strtod(given, &end);
  return *end == 0 && value >= 0.0 ? value : usual;
}

double seconds(std::chrono::steady_clock::duration time) {
  return std::chrono::duration<double>(time).count();
}

std::string clock_text(double seconds) {
  const long s = std::lround(std::min(seconds, 3.6e8));
  if (s < 3600) return formatted("%ld:%02ld", s / 60, s % 60);
  return formatted("%ld:%02ld:%02ld", s / 3600, s / 60 % 60, s % 60);
}

/// "  7 % "; empty while nothing is known.
std::string percent_text(double fraction) {
  if (fraction < 0.001) return "";
  return formatted("%3.0f %% ", 100.0 * std::min(fraction, 1.0));
}

/// ", 1:20 left", or the time spent while that is not known.
std::string time_text(double fraction, double spent, std::optional<double> left) {
  if (!left && fraction >= 0.001) left = spent * (1.0 - fraction) / fraction;
  return left ? ", " + clock_text(*left) + " left" : ", " + clock_text(spent);
}

}  // namespace

std::string progress_line(double fraction, const std::string& text, double spent, std::optional<double> left,
                          std::size_t columns, bool colors) {
  const std::string percent = percent_text(fraction);
  std::string behind = time_text(fraction, spent, left), bar;
  const std::size_t width = columns >= 60 ? 20 : columns >= 40 ? 10 : 0;
  if (width > 0) {
    const auto full = static_cast<std::size_t>(std::clamp(fraction, 0.0, 1.0) * static_cast<double>(width));
    const std::string done(full, '#'), rest(width - full, '.');
    bar = "[" + (colors && full > 0 ? "\033[32m" + done + "\033[0m" : done) + rest + "] ";
  }
  const std::size_t before = (width > 0 ? width + 3 : 0) + percent.size();
  if (before + behind.size() >= columns) behind.clear();
  const std::size_t room = columns > before + behind.size() ? columns - before - behind.size() : 0;
  return bar + percent + text.substr(0, room) + behind;
}

ProgressBar::ProgressBar(bool ticking)
    : terminal_(draws()),
      every_(terminal_ ? 0.0 : seconds_between_lines()),
      ticking_(ticking && (terminal_ || every_ > 0.0)),
      start_(Clock::now()),
      last_(start_) {
  if (ticking_) thread_ = std::thread([this] { tick(); });
}

ProgressBar::~ProgressBar() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    over_ = true;
  }
  wake_.notify_all();
  if (thread_.joinable()) thread_.join();
  clear();
}

void ProgressBar::show(double fraction, const std::string& text, std::optional<double> left) {
  set({fraction, fraction, text, left, Clock::now()});
}

void ProgressBar::stage(double from, double to, const std::string& text) {
  set({from, to, text, std::nullopt, Clock::now()});
}

void ProgressBar::set(const State& state) {
  if (!terminal_ && every_ <= 0.0) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  state_ = state;
  if (!terminal_ || state.since - last_ >= pause) draw();
}

void ProgressBar::draw() {
  const Clock::time_point now = Clock::now();
  if (!state_ || (terminal_ ? now - start_ < unseen : seconds(now - last_) < every_)) return;
  last_ = now;
  shown_ = terminal_;
  const double before = seconds(state_->since - start_), in_stage = seconds(now - state_->since);
  double fraction = state_->from;
  if (state_->to > state_->from && state_->from > 0.0) {  // nears its end, and never gets there by itself
    const double expected = std::max(before, 0.1) * (state_->to - state_->from) / state_->from;
    fraction += (state_->to - state_->from) * (1.0 - std::exp(-in_stage / expected));
  }
  std::optional<double> left = state_->left;
  if (!left && state_->to == state_->from && fraction >= 0.001)  // runs down until the caller reports more
    left = std::max(0.0, before * (1.0 - fraction) / fraction - in_stage);
  if (!terminal_)
    return put("bin_scenes: " + percent_text(fraction) + state_->text + time_text(fraction, before + in_stage, left) +
               "\n");
  // The last column stays free: a terminal may go to the next line behind it.
  put(erase_line +
      progress_line(fraction, state_->text, before + in_stage, left, columns_of_terminal() - 1, wants_colors()));
}

void ProgressBar::tick() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (!wake_.wait_for(lock, pause, [this] { return over_; })) draw();
}

void ProgressBar::clear() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (shown_) put(erase_line);
  shown_ = false;
  state_.reset();
}

}  // namespace bin_scenes
