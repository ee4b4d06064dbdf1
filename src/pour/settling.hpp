/// Settling of a heap as data: the phase of the solver in each stage, and the transitions between stages.
///
///     pour ─► settle ─► press ─► probe ─► verify ─► recheck ─► done    a stage in which parts rock on goes back to
///                                                                      settle; given poses start in hold, a heap from
///                                                                      which parts were taken out starts in repair
///
/// Finish::settled leaves out press, probe and recheck, and Finish::pressed leaves out probe and recheck. A heap that
/// forgets its forces before it counts as finished has shown that it does not rest on remembered friction alone.
///
/// A check is a probe, verify or recheck. If many parts move in one, it is repeated for the whole heap, for some
/// seconds after the pour. If a few do, or if it is late, these are checked again alone, until they rest or the number
/// of checks is used up: then they are reported as unstable.
#pragma once

#include "bin_scenes/solver/solver.hpp"

#include <array>

namespace bin_scenes {

enum class Stage { pour, settle, press, probe, verify, recheck, hold, repair, done };

struct StageRow {
  Stage stage;
  const char* name;
  Phase phase;  ///< settings of the solver in this stage
};

namespace phases {

using Sleep = Phase::Sleep;
// clang-format off
//                                 samples | stiffness      | friction | forgets | sleep          | begins asleep
/// Parts enter. Coarse samples suffice while everything moves.
inline constexpr Phase pour{        false, Stiffness::soft,  1.0,       false,    Sleep::by_island, false};
/// Fine samples and soft contacts, which damp rocking and leave overlap under load.
inline constexpr Phase settle{      true,  Stiffness::soft,  1.0,       false,    Sleep::by_island, false};
/// Stiff contacts remove the overlap that soft ones leave.
inline constexpr Phase press{       true,  Stiffness::stiff, 1.0,       false,    Sleep::by_island, false};
/// The heap starts without remembered forces, as in another engine, and for a moment without friction. Contacts push
/// nothing apart, and friction is reduced from now on. Parts near their friction limit slip or tip now instead of later.
/// Parts sleep one by one, so that one that creeps does not keep the others awake.
inline constexpr Phase probe{       true,  Stiffness::rigid, 0.9,       true,     Sleep::by_part,   false};
/// Pressed again without remembered forces, as when this solver continues from the poses.
inline constexpr Phase verify{      true,  Stiffness::stiff, 0.9,       true,     Sleep::by_island, false};
/// The few parts that moved in the last check are checked again, as in verify. All others sleep until one of these moves.
inline constexpr Phase recheck{     true,  Stiffness::stiff, 0.9,       true,     Sleep::by_touch,  true};
/// A heap given at rest continues on stiff contacts: softer or coarser ones would let it sink.
inline constexpr Phase hold = press;
/// Parts were removed: all others sleep, except those that touched them and those that these wake in turn.
inline constexpr Phase repair{      true,  Stiffness::stiff, 1.0,       false,    Sleep::by_touch,  true};
// clang-format on

}  // namespace phases

inline constexpr std::array<StageRow, 8> stage_rows{{{Stage::pour, "pour", phases::pour},
                                                     {Stage::settle, "settle", phases::settle},
                                                     {Stage::press, "press", phases::press},
                                                     {Stage::probe, "probe", phases::probe},
                                                     {Stage::verify, "verify", phases::verify},
                                                     {Stage::recheck, "recheck", phases::recheck},
                                                     {Stage::hold, "hold", phases::hold},
                                                     {Stage::repair, "repair", phases::repair}}};

inline constexpr const StageRow& row(Stage stage) {
  return stage_rows[static_cast<std::size_t>(stage)];
}

/// The state of a heap on which transitions depend. Counts are of parts that are in the bin and not fixed.
class HeapView {
 public:
  virtual ~HeapView() = default;
  virtual bool all_in() const = 0;      ///< whether no part waits to enter
  virtual bool all_slow() const = 0;    ///< whether no part moves as fast as a falling one
  virtual bool all_rest() const = 0;    ///< whether all have been still for Pour::rest_window
  virtual bool all_asleep() const = 0;  ///< whether the solver lets all bodies sleep
  virtual std::size_t count() const = 0;
  virtual std::size_t still_for_less_than(double seconds) const = 0;  ///< number that moved within the last `seconds`
  virtual double rest_window() const = 0;                             ///< s
};

/// The stages of one heap, from the start of a settle to its end.
class Settling {
 public:
  explicit Settling(Pour::Finish finish) : finish_(finish) {}

  /// Starts a new settle with its own clock.
  void start(Stage stage);
  /// For a solver without stages: settling is done when the heap has settled.
  void ignore_stages() { finish_ = Pour::Finish::settled, ignored_ = true; }
  /// Sets the clock of the present stage to 0.
  void start_clock();
  /// Returns the ages (s) for which a transition at `time` may call HeapView::still_for_less_than().
  std::array<double, 4> ages(const HeapView& heap, double time) const;
  /// Whether advance() would start a stage.
  bool will_change(const HeapView& heap, double time) const { return next(heap, time) != nullptr; }
  /// Applies the transitions at `time` (s since the start). Returns whether a stage began, the same one or another.
  bool advance(const HeapView& heap, double time);

  Stage stage() const { return stage_; }
  /// Returns the phase of the solver in this stage. Friction that was reduced stays reduced until the end.
  Phase phase() const;
  bool done() const { return stage_ == Stage::done; }
  /// Returns the duration (s) of the last check. Parts that moved within this time before the last transition moved in
  /// that check.
  double checked_s() const { return checked_s_; }
  /// Whether parts that moved in the last check were not checked again.
  bool gave_up() const { return gave_up_; }
  /// Returns how far the heap has been settled: "settled", "pressed", "probed", or "none" before settling is done.
  const char* finish() const;

 private:
  struct Seen;
  struct Transition;
  static const Transition transitions[];
  const Transition* next(const HeapView& heap, double time) const;
  Seen seen(const HeapView& heap, double time) const;
  void enter(Stage stage, double time);

  Pour::Finish finish_;
  bool ignored_ = false;                            ///< whether the solver has no stages
  Stage stage_ = Stage::pour, last_ = Stage::pour;  ///< last_: the stage before `done`
  double begun_ = 0.0;                              ///< s: start of the present stage
  double advanced_ = 0.0;                           ///< s: time of the last advance()
  int checks_ = 0;                                  ///< number of times that probe or verify began
  int rechecks_ = 0;                                ///< number of times that recheck began since the last of these
  double poured_ = 0.0;                             ///< s: time at which the pour ended
  double checked_s_ = 0.0;
  bool gave_up_ = false;
  double friction_ = 1.0;  ///< share of the coefficients of friction that acts; never rises again
};

}  // namespace bin_scenes
