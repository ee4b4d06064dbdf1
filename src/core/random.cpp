#include "bin_scenes/core/random.hpp"

#include "bin_scenes/core/assertion.hpp"

namespace bin_scenes {

namespace {
std::uint64_t mix(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}
constexpr std::uint64_t golden = 0x9e3779b97f4a7c15ULL;
}  // namespace

Random::Random(std::uint64_t seed, std::uint64_t index, Stream stream)
    : state_(mix(mix(mix(seed + golden) + index + golden) + static_cast<std::uint64_t>(stream) + golden)) {}

Random Random::of_piece(std::uint64_t piece) const {
  return Random(mix(mix(state_ + golden) ^ mix(piece + golden)));
}

std::uint64_t Random::next() {
  return mix(state_ += golden);
}

double Random::uniform() {
  return static_cast<double>(next() >> 11) * 0x1.0p-53;
}

double Random::uniform(double lower, double upper) {
  BIN_SCENES_ASSERT(lower <= upper);
  return lower + (upper - lower) * uniform();
}

std::uint64_t Random::below(std::uint64_t count) {
  BIN_SCENES_ASSERT(count > 0);
  // Reject the short last stretch of the 64-bit range, where some remainders would come once too often.
  const std::uint64_t limit = ~std::uint64_t{0} - (~std::uint64_t{0} % count + 1) % count;
  for (;;) {
    const std::uint64_t draw = next();
    if (draw <= limit) return draw % count;
  }
}

double Random::normal() {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
  return radius * std::cos(2.0 * M_PI * uniform());
}

void Random::normals(double& a, double& b) {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform())), angle = 2.0 * M_PI * uniform();
  a = radius * std::cos(angle);
  b = radius * std::sin(angle);
}

Quat Random::orientation() {
  const double u = uniform(), a = 2.0 * M_PI * uniform(), b = 2.0 * M_PI * uniform();
  const double r = std::sqrt(1.0 - u), s = std::sqrt(u);
  return Quat(s * std::cos(b), r * std::sin(a), r * std::cos(a), s * std::sin(b)).normalized();
}

}  // namespace bin_scenes
