/// Answers the questions of RestWatch and EnergyAudit for a heap whose world is observed by the device that simulates
/// it (solver/world_watch.hpp). The device numbers its observations; this class keeps their times, so that its answers
/// are in seconds.
#pragma once

#include "bin_scenes/solver/world_watch.hpp"

#include <array>
#include <vector>

namespace bin_scenes {

class DeviceWatch {
 public:
  using Ages = std::array<double, 4>;  ///< s

  DeviceWatch(WorldWatch& watch, const WatchRules& rules, double rest_window)
      : watch_(&watch), rules_(rules), window_(rest_window) {}

  /// States that the heap is in another world from now on: the observation of rest and energies starts again, and the
  /// largest earlier gains are kept.
  void begin_world(WorldId world);
  void leave_world();  ///< must be called before the world is removed
  /// Sets the clock to 0; no earlier observation counts.
  void restart();
  void restart_rest() { rest_anew_ = true; }
  void enter(std::size_t body) { watch_->enter(world_, body); }

  /// States that the next steps end at `time`, at which the heap is observed. `ages`: the times for which moved() will
  /// be called.
  void ask(double time, const Ages& ages, bool driven, bool states);
  /// States that the next steps end without an observation.
  void ask_nothing(bool states);
  /// States that the steps have ended, and takes the observation that was requested for their end.
  void take();
  void note_states() { states_ = true; }

  bool observed() const { return observed_; }   ///< whether there was an observation since restart()
  bool is_current() const { return current_; }  ///< whether the observation belongs to the end of the last steps
  bool has_states() const { return states_; }   ///< whether the states belong to the end of the last steps
  /// Whether the states were asked for and not read: the world has ended its steps earlier than its device expected.
  bool lacks_states() const { return asked_states_ && !states_; }
  const WatchSeen& seen() const { return watch_->seen(world_); }
  /// Returns the number of bodies that moved within the last `age` seconds, which must be one of the ages given to
  /// ask().
  std::size_t moved(double age) const;
  /// Returns the time (s) since a body last moved, and whether it has been at rest for the window, by the states that
  /// were read last.
  double still(std::size_t body) const;
  bool resting(std::size_t body) const;
  bool is_outside(std::size_t body) const { return watch_->bodies(world_)[body].outside; }

  EnergyReport energy() const;
  WorstReport::EnergyGain energy_of_all() const;

 private:
  std::uint32_t first_younger_than(double age) const;
  void merge(WatchedEnergy energy);
  WatchedEnergy timed(WatchedEnergy energy) const;

  WorldWatch* watch_;
  WatchRules rules_;
  double window_;  ///< s
  WorldId world_ = 0;
  std::vector<double> times_{0.0};  ///< s, by number of observation: its time; entry 0 means no observation
  Ages ages_{};
  std::uint32_t rested_ = 0;  ///< bodies that last moved in this observation or earlier are at rest
  bool rest_anew_ = true, energy_anew_ = true, asked_ = false, observed_ = false, current_ = false, states_ = true;
  bool asked_states_ = false;
  WatchedEnergy earlier_;  ///< gains of earlier worlds of the heap, with their times
};

}  // namespace bin_scenes
