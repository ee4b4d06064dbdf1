/// Random numbers that depend on a key only, never on the order of calls elsewhere: scene i of a batch draws the same
/// numbers as the same scene alone. The standard library's distributions are not used, because they differ between
/// implementations.
#pragma once

#include "bin_scenes/core/types.hpp"

#include <cstdint>

namespace bin_scenes {

/// The purpose of a stream of random numbers. The streams of one scene are independent of each other.
enum class Stream : std::uint64_t { pour = 1, sensor = 2, noise = 3, probe = 4, plan = 5 };

/// A generator of random numbers: SplitMix64 (Steele, Lea, Flood 2014, "Fast splittable pseudorandom number
/// generators"), keyed by (seed, scene index, stream). Seed 0 is a seed like any other.
class Random {
 public:
  Random(std::uint64_t seed, std::uint64_t index, Stream stream);
  /// Returns a separate stream for one piece of the work (a sensor, or a row of its image), so that pieces may be
  /// processed in any order. The state of this stream does not change.
  Random of_piece(std::uint64_t piece) const;

  /// Each call returns the next number of the stream; next() returns 64 random bits.
  std::uint64_t next();
  double uniform();                            ///< uniform in [0, 1), with 53 random bits
  double uniform(double lower, double upper);  ///< uniform in [lower, upper)
  std::uint64_t below(std::uint64_t count);    ///< uniform among 0 .. count - 1, without bias; requires count > 0
  double normal();                             ///< mean 0, standard deviation 1 (Box-Muller)
  void normals(double& a, double& b);          ///< two independent numbers as of normal(), at the cost of one
  Quat orientation();  ///< uniform over all rotations (Shoemake 1992, "Uniform random rotations")

 private:
  explicit Random(std::uint64_t state) : state_(state) {}
  std::uint64_t state_;
};

}  // namespace bin_scenes
