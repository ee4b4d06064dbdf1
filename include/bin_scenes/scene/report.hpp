/// The report of a finished scene: quality figures, limits that were exceeded, times and flags. Penetration, gap and
/// drift are measured on the true meshes (quality/), not on the collision shapes of a solver. Keys are described with
/// their units in a table (src/scene/report_keys.hpp), which docs/use/scene.md prints; the comments here describe only
/// what is not a key.
#pragma once

#include "bin_scenes/core/profile.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace bin_scenes {

/// A remark for the user, with a remedy; for example, a buffer was enlarged or a mesh was repaired. `code` is a short
/// fixed name.
struct Flag {
  std::string code;
  std::string text;
  std::string remedy;
};

/// The median, the 95 % quantile and the maximum of a set of values (m).
struct Quantiles {
  double median = 0.0, p95 = 0.0, max = 0.0;
};
/// Returns the quantiles of values in any order; all 0 if there are none.
Quantiles quantiles(std::vector<double> values);

/// Overlap of the parts with each other and with the bin, in the final poses.
struct PenetrationReport : Quantiles {
  std::array<int, 2> pair = {-1, -1};
  double p95_relative = 0.0, max_relative = 0.0;
  std::size_t pairs = 0;
  double bin_median = 0.0, bin_p95 = 0.0, bin_max = 0.0;
  int bin_part = -1;
};

struct DriftReport
    : Quantiles {  ///< m, displacement of the centres of mass while the scene is simulated for another 0.5 s
  bool measured = false;
  double turn_p95 = 0.0;
};

/// The largest gain of energy of a part that nothing explains. A large value means that contacts threw a part.
struct EnergyReport {
  double gain = 0.0;
  double time = 0.0;
  int part = -1;

  /// The part that left its neighbours fastest in comparison with their own speed. This measure finds light parts that
  /// were pinched out, whose energy is small. A bounce may separate bodies at 1 + restitution times their approach
  /// speed; the ratio is divided by that number.
  struct Thrown {
    double ratio = 0.0;
    double time = 0.0;
    int part = -1;
    int beside = -1;
  } thrown;
};

/// The worst values of the whole simulation and not only of its end. A scene that looks right at the end may have gone
/// wrong before.
struct WorstReport {
  /// The deepest contact, according to the solver's own contact depths.
  struct Penetration {
    bool known = false;  ///< whether the solver reports the depths of its contacts
    double value = 0.0;
    double relative = 0.0;
    std::array<int, 2> pair = {-1, -1};
    double time = 0.0;
  } penetration;
  /// The largest rise of the total energy of all parts above the lowest value that it had before.
  struct EnergyGain {
    double relative = 0.0;
    double time = 0.0;
  } energy_gain;
  std::uint64_t unresolved_impacts = 0;
};

/// The part that opposite contacts squeeze most.
struct JamReport {
  double ratio = 0.0;
  int part = -1;
};

/// Everything that is known about how a scene was made and how good it is.
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
