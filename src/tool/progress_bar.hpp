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
  /// Draws on standard error, after the first half second: shorter jobs need no bar.
  /// @param ticking  whether a thread redraws the bar while the caller is busy; not for a process that forks and
  ///                 continues in the child.
  explicit ProgressBar(bool ticking = true);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// @param left  remaining time (s), if the caller has a better estimate than the elapsed time and the fraction give
  void show(double fraction, const std::string& text, std::optional<double> left = std::nullopt);
  /// Begins a stage without reports of progress. `from`, `to`: typical fractions of the job at its beginning and end.
  void stage(double from, double to, const std::string& text);
  void clear();  ///< erases the bar, before other text is printed

 private:
  using Clock = std::chrono::steady_clock;
  struct State {
    double from = 0.0, to = 0.0;  ///< fraction of the job at the beginning and at the end of the stage
    std::string text;
    std::optional<double> left;
    Clock::time_point since;
  };
  void set(const State& state);
  void draw();
  void tick();

  bool terminal_;
  double every_;  ///< time between lines (s) if there is no terminal; 0: no lines
  bool ticking_, shown_ = false, over_ = false;
  Clock::time_point start_, last_;
  std::optional<State> state_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::thread thread_;
};

/// Returns the text of the bar with at most `columns` characters, without those that set colours. `spent`: elapsed time
/// (s). If `left` is not given, it follows from `fraction` and `spent`; a fraction below 0.001 is shown as unknown.
std::string progress_line(double fraction, const std::string& text, double spent, std::optional<double> left,
                          std::size_t columns, bool colors);

}  // namespace bin_scenes
