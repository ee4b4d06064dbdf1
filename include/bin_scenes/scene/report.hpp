/// Report of a finished scene, measured on the true meshes (quality/), not on a solver's collision shapes. Meaning and
/// unit of a field are in the table of keys (src/scene/report_keys.hpp), which docs/use/scene.md prints; comments here
/// are of fields that are no keys.
#pragma once

#include "bin_scenes/core/profile.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace bin_scenes {

/// A remark for the user, with a remedy: a buffer that was enlarged, a mesh that was repaired.
struct Flag {
  std::string code;
  std::string text;
  std::string remedy;
};

/// Quantiles over pairs (m).
struct Quantiles {
  double median = 0.0, p95 = 0.0, max = 0.0;
};
Quantiles quantiles(std::vector<double> values);

struct PenetrationReport : Quantiles {
  std::array<int, 2> pair = {-1, -1};
  double p95_relative = 0.0, max_relative = 0.0;
  std::size_t pairs = 0;
  double bin_median = 0.0, bin_p95 = 0.0, bin_max = 0.0;
  int bin_part = -1;
};

struct DriftReport : Quantiles {  ///< m: move of the centre of mass in 0.5 s of a re-run
  bool measured = false;
  double turn_p95 = 0.0;
};

/// Energy that a part gained and that nothing gave it: a solver whose contacts throw parts about.
struct EnergyReport {
  double gain = 0.0;
  double time = 0.0;
  int part = -1;

  /// A part that left others faster than any of them was: what a pinch throws out is light, and its energy small.
  /// What bounces may leave 1 + restitution times as fast; its ratio is divided by that.
  struct Thrown {
    double ratio = 0.0;
    double time = 0.0;
    int part = -1;
    int beside = -1;
  } thrown;
};

/// The worst of the whole run, not of its end: a scene that looks right may have gone wrong before.
struct WorstReport {
  /// Deepest contact, by the solver's own depths.
  struct Penetration {
    bool known = false;  ///< whether the solver reports the depths of its contacts
    double value = 0.0;
    double relative = 0.0;
    std::array<int, 2> pair = {-1, -1};
    double time = 0.0;
  } penetration;
  /// Rise of the energy of all parts together above the least that it was before.
  struct EnergyGain {
    double relative = 0.0;
    double time = 0.0;
  } energy_gain;
  std::uint64_t unresolved_impacts = 0;
};

/// The part that contacts squeeze most, from opposite sides.
struct JamReport {
  double ratio = 0.0;
  int part = -1;
};

struct Report {
  bool at_rest = false;
  bool accepted = false;
  std::vector<std::string> reasons;
  std::string solver;
  std::string solver_reason;
  std::string device;
  std::string finish;
  double simulated_s = 0.0, wall_s = 0.0;
  std::uint64_t steps = 0;
  Profile profile;
  PenetrationReport penetration;
  Quantiles gap;
  DriftReport drift;
  EnergyReport energy;
  JamReport jam;
  WorstReport worst;
  std::vector<int> escaped;
  std::vector<int> unstable;
  std::vector<int> not_poured;
  std::uint64_t state_hash = 0;
  std::vector<Flag> flags;
};

}  // namespace bin_scenes
