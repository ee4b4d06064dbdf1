/// Observation of a world by the device that simulates it: which bodies are at rest, which have left the bin, and how
/// much energy was gained. The host then reads a few counts for each world, and reads the states of the bodies only
/// when it asks for them. A solver whose states are in the memory of the host has no WorldWatch: there, HeapCore
/// (src/pour) observes the states with RestWatch and EnergyAudit.
///
/// An observation takes place at the end of the begin() for which it was requested. The caller numbers its observations
/// 1, 2, ... in ascending order, and keeps their times.
#pragma once

#include "bin_scenes/scene/report.hpp"
#include "bin_scenes/solver/solver.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace bin_scenes {

/// Rules that are constant for a world.
struct WatchRules {
  Vec3 lower, upper;  ///< m: a body whose centre of mass is beyond these bounds has left the bin; they may be infinite
  double rest_move = 0.0;  ///< RestWatch::Limits::move in diagonals of the part
  double rest_turn = 0.0;  ///< RestWatch::Limits::turn (rad)
};

/// What to observe at the end of the next begin().
struct WatchAsk {
  std::uint32_t observation = 0;  ///< number of the observation; 0: none
  double seconds = 0.0;           ///< simulated time since the last observation (s)
  bool rest_anew = false;         ///< the observation of rest starts again: no earlier pose counts
  bool energy_anew = false;  ///< the observation of energy starts again with this begin(): no earlier energy and no
                             ///< earlier maximum counts
  bool driven = false;  ///< whether moving fixed bodies or a moving frame may have given energy to the bodies since the
                        ///< last observation (EnergyAudit::observe())
  bool states = false;  ///< whether the states of the bodies are read as well
  /// For each of these observations, the bodies that moved in it or later are counted.
  std::array<std::uint32_t, 4> since{};
  std::uint32_t rested = 0;  ///< a further observation: the bodies that moved after it are counted as well
};

/// Counts of the movable bodies that are present.
struct WatchSeen {
  std::uint32_t observation = 0;
  std::size_t outside = 0;              ///< bodies that have left the bin; the other counts do not include them
  std::size_t fast = 0;                 ///< bodies that move as fast as falling ones
  std::size_t awake = 0, unrested = 0;  ///< unrested: bodies that moved after WatchAsk::rested
  std::array<std::size_t, 4> moved{};   ///< by WatchAsk::since
  bool states = false;                  ///< whether the states were read
};

/// The last known observation of one body.
struct WatchedBody {
  std::uint32_t moved = 0;  ///< number of the last observation in which the body had moved; 0: never observed
  bool outside = false;     ///< whether it has left the bin
};

/// The largest gains of energy since their observation started, as last read. Times are numbers of observations.
struct WatchedEnergy {
  EnergyReport parts;
  WorstReport::EnergyGain all;
};

/// Observes the worlds of one solver.
class WorldWatch {
 public:
  virtual ~WorldWatch() = default;
  virtual void set_rules(WorldId world, const WatchRules& rules) = 0;
  /// States that a body was inserted: its energy starts with the state with which it was inserted.
  virtual void enter(WorldId world, std::size_t body) = 0;
  /// Requests an observation at the end of the next begin().
  virtual void ask(WorldId world, const WatchAsk& ask) = 0;
  /// As Solver::begin() and Solver::finish(), for worlds that do not wait for one another: while a body is fast, a step
  /// is several shorter ones, and meanwhile the device would have nothing to do for the other worlds. finish_some()
  /// leaves worlds whose steps are not done under way. A later begin_some() or begin() goes on with their steps, while
  /// steps of the other listed worlds begin; finish() ends them.
  /// @param seconds  for worlds whose steps begin: a multiple of Solver::step_size()
  virtual void begin_some(const std::vector<WorldId>& worlds, double seconds) = 0;
  virtual void finish_some(const std::vector<WorldId>& worlds) = 0;
  /// Returns whether steps of a world that was begun are not done. Such a world must not be read or changed.
  virtual bool under_way(WorldId world) const = 0;
  /// Returns the counts of the last observation. Valid after finish().
  virtual const WatchSeen& seen(WorldId world) const = 0;
  /// Reads the worlds from the device and waits for it. Afterwards states(), asleep(), bodies() and energy() are up to
  /// date.
  virtual void read(const std::vector<WorldId>& worlds) = 0;
  virtual const std::vector<WatchedBody>& bodies(WorldId world) const = 0;
  virtual WatchedEnergy energy(WorldId world) const = 0;
};

}  // namespace bin_scenes
