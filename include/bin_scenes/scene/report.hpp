/// Report of a finished scene, measured on the true meshes (quality/), not on a solver's collision shapes.
#pragma once

#include "bin_scenes/core/profile.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace bin_scenes {

/// A remark for the user, with a remedy: a buffer that was enlarged, a mesh that was repaired.
struct Flag {
  std::string code;    ///< stable, snake_case: "mesh_repaired", "contact_overflow"
  std::string text;    ///< description with figures
  std::string remedy;  ///< setting to change, or action to take
};

/// Quantiles over pairs (m).
struct Quantiles {
  double median = 0.0, p95 = 0.0, max = 0.0;
};
Quantiles quantiles(std::vector<double> values);

struct PenetrationReport : Quantiles {
  std::array<int, 2> pair = {-1, -1};                     ///< ids of the worst pair; {-1, -1} if nothing overlaps
  double p95_relative = 0.0, max_relative = 0.0;          ///< / smaller part's bounding diagonal
  std::size_t pairs = 0;                                  ///< overlapping pairs
  double bin_median = 0.0, bin_p95 = 0.0, bin_max = 0.0;  ///< over the parts that overlap the bin (m)
  int bin_part = -1;                                      ///< id of the worst of them; -1 if none
};

struct DriftReport : Quantiles {  ///< m: move of the centre of mass in 0.5 s of a re-run
  bool measured = false;
  double turn_p95 = 0.0;  ///< rad
};

/// Energy that a part gained and that nothing gave it: a solver whose contacts throw parts about.
struct EnergyReport {
  double gain = 0.0;  ///< largest between two looks / (m g d) of the part; m mass, d diagonal of its bounding box
  double time = 0.0;  ///< s, simulated, of the look that found it
  int part = -1;      ///< id; -1 if no part gained energy

  /// A part that left others faster than any of them was: what a pinch throws out is light, and its energy small.
  struct Thrown {
    double ratio = 0.0;  ///< largest (speed - gravity * time between two looks) / fastest of those near it before, a
                         ///< turn counted at the radius; of what bounces, over 1 + restitution
    double time = 0.0;   ///< s, simulated, of the look that found it
    int part = -1;       ///< id; -1 if none was thrown
    int beside = -1;     ///< id of the nearest part before, -1 if only the bin was near
  } thrown;
};

/// The worst of the whole run, not of its end: a scene that looks right may have gone wrong before.
struct WorstReport {
  /// Deepest contact, by the solver's own depths.
  struct Penetration {
    bool known = false;                  ///< whether the solver reports the depths of its contacts
    double value = 0.0;                  ///< m
    double relative = 0.0;               ///< value / diagonal of the smaller part; the largest of the run
    std::array<int, 2> pair = {-1, -1};  ///< ids; the second is -1 for the bin, both are if nothing overlapped
    double time = 0.0;                   ///< s, simulated
  } penetration;
  /// Rise of the energy of all parts together above the least that it was before.
  struct EnergyGain {
    double relative = 0.0;  ///< rise / (m g d) summed over the parts that moved
    double time = 0.0;      ///< s, simulated, of the observation that found it
  } energy_gain;
  std::uint64_t unresolved_impacts = 0;  ///< sub-steps in which an impact was not solved within the allowed sweeps
};

/// The part that contacts squeeze most, from opposite sides.
struct JamReport {
  double ratio = 0.0;  ///< force / weight of it and of what lies on it, all of which it may have to carry
  int part = -1;       ///< id; -1 if nothing presses, or the solver reports no contacts
};

struct Report {
  bool at_rest = false;
  bool accepted = false;
  std::vector<std::string> reasons;  ///< why not accepted
  std::string solver;                ///< "sphere", "sphere/thesis", "bullet"
  std::string solver_reason;         ///< why `auto` chose it
  std::string device;                ///< GL_RENDERER, or "cpu"
  std::string finish;                ///< "settled", "pressed", "probed": what was done; "none": time ran out before
  double simulated_s = 0.0, wall_s = 0.0;
  std::uint64_t steps = 0;
  Profile profile;
  PenetrationReport penetration;
  Quantiles gap;  ///< m: free fall of the parts at rest
  DriftReport drift;
  EnergyReport energy;
  JamReport jam;
  WorstReport worst;
  std::vector<int> escaped;      ///< ids outside the bin, below the floor or not finite
  std::vector<int> unstable;     ///< ids that moved in each check of how they stand, to the last one
  std::vector<int> not_poured;   ///< ids that found no room above the heap
  std::uint64_t state_hash = 0;  ///< of all final poses, bit for bit
  std::vector<Flag> flags;
};

}  // namespace bin_scenes
