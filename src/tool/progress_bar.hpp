/// Prints the progress of a job and the remaining time in one line of a terminal. If standard error is not a terminal,
/// a line is printed every 30 s; BIN_SCENES_PROGRESS sets another number of seconds, and 0 switches it off.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace bin_scenes {

class ProgressBar {
 public:
  /// Draws on standard error from half a second on: what is done sooner needs no bar.
  /// @param ticking  a thread redraws while the caller is busy. Not for a process that forks and continues in the
  /// child.
  explicit ProgressBar(bool ticking = true);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// @param left  seconds, where the caller knows better than by the fraction and the time spent
  void show(double fraction, const std::string& text, std::optional<double> left = std::nullopt);
  /// A stage that reports nothing until it ends: shares of the whole job at its beginning and its end, by experience.
  void stage(double from, double to, const std::string& text);
  void clear();  ///< before other text

 private:
  using Clock = std::chrono::steady_clock;
  struct State {
    double from = 0.0, to = 0.0;  ///< share of the job done, and at the end of the stage
    std::string text;
    std::optional<double> left;
    Clock::time_point since;
  };
  void set(const State& state);
  void draw();
  void tick();

  bool terminal_;
  double every_;  ///< s between lines where there is no terminal; 0: none
  bool ticking_, shown_ = false, over_ = false;
  Clock::time_point start_, last_;
  std::optional<State> state_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::thread thread_;
};

/// The line itself, at most `columns` wide, colours not counted. `fraction` below 0.001 is not known yet, then the time
/// spent is used for the time left.
std::string progress_line(double fraction, const std::string& text, double spent, std::optional<double> left,
                          std::size_t columns, bool colors);

}  // namespace bin_scenes
