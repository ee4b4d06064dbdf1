/// Random numbers that depend on a key alone, never on the order of calls elsewhere: scene i of a batch draws the
/// same numbers as the same scene alone. The standard library's distributions differ between implementations and
/// are therefore not used.
#pragma once

#include "bin_scenes/core/types.hpp"

#include <cstdint>

namespace bin_scenes {

/// What a stream of random numbers is for; streams of one scene are independent of each other.
enum class Stream : std::uint64_t { pour = 1, sensor = 2, noise = 3, probe = 4, plan = 5 };

/// SplitMix64 (Steele, Lea, Flood 2014, "Fast splittable pseudorandom number generators"), keyed by
/// (seed, scene index, stream). Seed 0 is a seed like any other.
class Random {
 public:
  Random(std::uint64_t seed, std::uint64_t index, Stream stream);
  /// A separate stream for one piece of the work (a sensor, a row of its image), so that pieces may be done in any
  /// order. The state of this stream does not change.
  Random of_piece(std::uint64_t piece) const;

  std::uint64_t next();
  double uniform();                            ///< [0, 1), 53 bits
  double uniform(double lower, double upper);  ///< [lower, upper)
  std::uint64_t below(std::uint64_t count);    ///< 0 .. count-1, unbiased; count > 0
  double normal();                             ///< mean 0, standard deviation 1 (Box-Muller)
  void normals(double& a, double& b);          ///< two such numbers at the cost of one
  Quat orientation();                          ///< uniform on SO(3) (Shoemake 1992, "Uniform random rotations")

 private:
  explicit Random(std::uint64_t state) : state_(state) {}
  std::uint64_t state_;
};

}  // namespace bin_scenes
