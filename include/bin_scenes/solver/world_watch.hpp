/// Observation of a world by the device that simulates it: who rests, who has left the bin, and what energy was gained.
/// The host reads a few counts for a world; states of bodies only when it asks for them. A solver whose states are in
/// the host's memory has no such watch: there, HeapCore observes states with RestWatch and EnergyAudit.
///
/// An observation follows the steps of a begin() for which it was asked. Observations are numbered by the caller, from
/// 1 on and ascending; times stay with the caller.
#pragma once

#include "bin_scenes/scene/report.hpp"
#include "bin_scenes/solver/solver.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace bin_scenes {

/// What holds for a world from its beginning to its end.
struct WatchRules {
  Vec3 lower, upper;       ///< m: a centre of mass beyond these has left the bin; may be infinite
  double rest_move = 0.0;  ///< diagonals of the part: RestWatch::Limits::move
  double rest_turn = 0.0;  ///< rad
};

/// What the next begin() is to end with.
struct WatchAsk {
  std::uint32_t observation = 0;         ///< its number; 0: none
  double seconds = 0.0;                  ///< since the last observation
  bool rest_anew = false;                ///< no pose of before counts
  bool energy_anew = false;              ///< all energies begin with this begin(), and no worst of before counts
  bool driven = false;                   ///< EnergyAudit::observe()
  bool states = false;                   ///< states are read, too
  std::array<std::uint32_t, 4> since{};  ///< bodies that moved in or after each of these observations are counted
  std::uint32_t rested = 0;              ///< and those that moved after this one
};

/// Counts of the moving bodies that are in.
struct WatchSeen {
  std::uint32_t observation = 0;
  std::size_t outside = 0;              ///< have left the bin, and are counted nowhere else
  std::size_t fast = 0;                 ///< move as fast as falling ones
  std::size_t awake = 0, unrested = 0;  ///< unrested: moved after WatchAsk::rested
  std::array<std::size_t, 4> moved{};   ///< by WatchAsk::since
  bool states = false;                  ///< states were read
};

/// Of one body, as it was read last.
struct WatchedBody {
  std::uint32_t moved = 0;  ///< last observation in which it was not near the pose before; 0: never observed
  bool outside = false;     ///< it has left the bin
};

/// The worst since energies began anew, as it was read last. Times are numbers of observations.
struct WatchedEnergy {
  EnergyReport parts;
  WorstReport::EnergyGain all;
};

class WorldWatch {
 public:
  virtual ~WorldWatch() = default;
  virtual void set_rules(WorldId world, const WatchRules& rules) = 0;
  /// A body was put in anew: its energy begins with the state that it was inserted with.
  virtual void enter(WorldId world, std::size_t body) = 0;
  virtual void ask(WorldId world, const WatchAsk& ask) = 0;
  /// Of the last observation, after finish().
  virtual const WatchSeen& seen(WorldId world) const = 0;
  /// Makes states(), asleep(), and what follows here those of now. It waits for the device.
  virtual void read(const std::vector<WorldId>& worlds) = 0;
  virtual const std::vector<WatchedBody>& bodies(WorldId world) const = 0;
  virtual WatchedEnergy energy(WorldId world) const = 0;
};

}  // namespace bin_scenes
